use glam::{Vec2, Vec3};
use relievo_scene::{ReliefDepth, Scene, SurfaceMesh, Vertex};

use super::bvh::{Bounds, TriangleBvh};
use crate::RenderError;
use crate::shading::material::MaterialShading;

/// Limit of the number of triangles: more would take over 4 GB of memory.
const MAX_TRIANGLES: u64 = 16_000_000;

/// An object of the scene.
pub(crate) struct Instance {
    pub(crate) material: usize,
    /// Upper corner of the texture range: the lower one is (0, 0).
    pub(crate) repeat: Vec2,
    pub(crate) depth: ReliefDepth,
}

/// The scene made ready for tracing: its triangles in two trees, its materials.
pub(crate) struct World {
    pub(crate) materials: Vec<MaterialShading>,
    pub(crate) instances: Vec<Instance>,
    pub(crate) surface_mesh: SurfaceMesh,
    /// The instance that each triangle belongs to.
    pub(crate) owner: Vec<u32>,
    /// The triangles that are the surface, or have it below them: no part of the surface lies before the polygon.
    pub(crate) bvh: TriangleBvh,
    /// The triangles whose relief rises above them. The surface may be far from where a ray meets the polygon, so that no
    /// distance rules one out.
    pub(crate) raised_bvh: TriangleBvh,
}

impl World {
    pub(crate) fn new(scene: &Scene) -> Result<Self, RenderError> {
        let materials: Vec<MaterialShading> =
            scene.materials.iter().map(|material| MaterialShading::new(material, scene.shading.color_space)).collect();
        let mut surface_mesh = SurfaceMesh::default();
        let mut owner = Vec::new();
        let mut instances = Vec::new();
        for (index, object) in scene.objects.iter().enumerate() {
            let material = &materials[object.material];
            let instance = Instance {
                material: object.material,
                repeat: object.uv_repeat,
                depth: ReliefDepth::new(material.range, object),
            };
            let mut part = SurfaceMesh::in_scene_space(object);
            let grid = if material.is_displaced() { material.relief.grid } else { 1 };
            let triangles = owner.len() as u64 + part.displaced_count(grid, object.uv_repeat);
            if triangles > MAX_TRIANGLES {
                return Err(RenderError::TooManyTriangles { object: index, triangles, grid, max: MAX_TRIANGLES });
            }
            if let Some(heights) = material.heights.as_ref().filter(|_| material.is_displaced()) {
                let field = material.field(heights, 0.0, object.uv_repeat);
                part = part.displaced(&field, &instance.depth, material.midlevel, grid, object.uv_repeat);
            }
            let offset = surface_mesh.vertices.len() as u32;
            owner.resize(owner.len() + part.triangles.len(), instances.len() as u32);
            surface_mesh.triangles.extend(part.triangles.iter().map(|t| t.map(|i| i + offset)));
            surface_mesh.vertices.append(&mut part.vertices);
            instances.push(instance);
        }
        let bvh_of = |raised: bool| {
            let chosen = |triangle: &u32| {
                materials[instances[owner[*triangle as usize] as usize].material].is_raised() == raised
            };
            let triangles: Vec<u32> = (0..owner.len() as u32).filter(chosen).collect();
            let corners =
                |&t: &u32| surface_mesh.triangles[t as usize].map(|i| surface_mesh.vertices[i as usize].position);
            let bounds: Vec<Bounds> = triangles.iter().map(|t| Bounds::around(corners(t))).collect();
            TriangleBvh::build(&bounds, &triangles)
        };
        let (bvh, raised_bvh) = (bvh_of(false), bvh_of(true));
        Ok(Self { materials, instances, surface_mesh, owner, bvh, raised_bvh })
    }

    /// Index of the material of a triangle.
    pub(crate) fn material_of(&self, triangle: u32) -> u32 {
        self.instances[self.owner[triangle as usize] as usize].material as u32
    }

    pub(crate) fn corners(&self, triangle: u32) -> [&Vertex; 3] {
        self.surface_mesh.triangles[triangle as usize].map(|i| &self.surface_mesh.vertices[i as usize])
    }

    pub(crate) fn instance_of(&self, triangle: u32) -> (&Instance, &MaterialShading) {
        let instance = &self.instances[self.owner[triangle as usize] as usize];
        (instance, &self.materials[instance.material])
    }

    /// Positions of the corners of a triangle.
    pub(crate) fn positions(&self, triangle: u32) -> [Vec3; 3] {
        self.corners(triangle).map(|corner| corner.position)
    }
}
