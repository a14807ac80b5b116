use glam::{Vec2, Vec3};
use relievo_scene::{ReliefDepth, Scene, SurfaceMesh, Vertex};

use super::bvh::{Bounds, TriangleBvh};
use super::displaced::{HeightRanges, MicroHit, MicroRay, MicroSurface, RangedMap, Sides};
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
    /// The first of its triangles.
    first_triangle: u32,
    /// Triangles that each triangle of its mesh was cut into.
    pieces: u32,
    /// The surface that is traced over its triangles instead of these.
    micro: Option<MicroSurface>,
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
    /// The triangles whose displaced surface is traced without being kept.
    pub(crate) micro_bvh: TriangleBvh,
    /// Ranges of the height maps of those, by material.
    ranges: Vec<Option<HeightRanges>>,
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
            let mut instance = Instance {
                material: object.material,
                repeat: object.uv_repeat,
                depth: ReliefDepth::new(material.range, object),
                first_triangle: owner.len() as u32,
                pieces: 1,
                micro: None,
            };
            let mut part = SurfaceMesh::in_scene_space(object);
            instance.micro = micro_surface(&part, &instance, material);
            let keeps_grid = material.is_displaced() && instance.micro.is_none();
            let grid = if keeps_grid { material.relief.grid } else { 1 };
            let triangles = owner.len() as u64 + part.displaced_count(grid, object.uv_repeat);
            if triangles > MAX_TRIANGLES {
                return Err(RenderError::TooManyTriangles { object: index, triangles, grid, max: MAX_TRIANGLES });
            }
            if let Some(heights) = material.heights.as_ref().filter(|_| keeps_grid) {
                let count = part.triangles.len().max(1);
                let field = material.field(heights, 0.0, object.uv_repeat);
                part = part.displaced(&field, &instance.depth, material.midlevel, grid, object.uv_repeat);
                instance.pieces = (part.triangles.len() / count) as u32;
            }
            let offset = surface_mesh.vertices.len() as u32;
            owner.resize(owner.len() + part.triangles.len(), instances.len() as u32);
            surface_mesh.triangles.extend(part.triangles.iter().map(|t| t.map(|i| i + offset)));
            surface_mesh.vertices.append(&mut part.vertices);
            instances.push(instance);
        }
        let bvh_of = |raised: bool| {
            let chosen = |triangle: &u32| {
                let instance = &instances[owner[*triangle as usize] as usize];
                materials[instance.material].is_raised() == raised && instance.micro.is_none()
            };
            let triangles: Vec<u32> = (0..owner.len() as u32).filter(chosen).collect();
            let corners =
                |&t: &u32| surface_mesh.triangles[t as usize].map(|i| surface_mesh.vertices[i as usize].position);
            let bounds: Vec<Bounds> = triangles.iter().map(|t| Bounds::around(corners(t))).collect();
            TriangleBvh::build(&bounds, &triangles)
        };
        let (bvh, raised_bvh) = (bvh_of(false), bvh_of(true));
        let is_traced = |material: usize| instances.iter().any(|i| i.material == material && i.micro.is_some());
        let ranges = materials.iter().enumerate().map(|(index, material)| {
            let heights = material.heights.as_ref().filter(|_| is_traced(index))?;
            Some(HeightRanges::build(heights.levels().first()?))
        });
        let ranges = ranges.collect();
        let micro_bvh = TriangleBvh::default();
        let mut this = Self { materials, instances, surface_mesh, owner, bvh, raised_bvh, micro_bvh, ranges };
        this.micro_bvh = this.build_micro_bvh();
        Ok(this)
    }

    fn build_micro_bvh(&self) -> TriangleBvh {
        let (bounds, triangles): (Vec<Bounds>, Vec<u32>) = (0..self.owner.len() as u32)
            .filter_map(|triangle| {
                let (micro, heights) = self.micro_surface(triangle)?;
                let [min, max] = micro.bounds(&self.surface_mesh, triangle, heights);
                Some((Bounds::between(min, max), triangle))
            })
            .unzip();
        TriangleBvh::build(&bounds, &triangles)
    }

    /// Returns the displaced surface that is traced over a triangle, and its height map.
    fn micro_surface(&self, triangle: u32) -> Option<(&MicroSurface, RangedMap<'_>)> {
        let instance = &self.instances[self.owner[triangle as usize] as usize];
        let micro = instance.micro.as_ref()?;
        let ranges = self.ranges[instance.material].as_ref()?;
        let map = self.materials[instance.material].heights.as_ref()?.levels().first()?;
        Some((micro, RangedMap { map, ranges }))
    }

    /// Returns the point where a ray first meets the displaced surface over a triangle of [`World::micro_bvh`], nearer than
    /// `limit`; `raise` moves the surface along its normals, in texels.
    pub(crate) fn micro_hit(
        &self,
        triangle: u32,
        ray: &MicroRay,
        raise: f64,
        limit: f32,
        sides: Sides,
    ) -> Option<MicroHit> {
        let (micro, heights) = self.micro_surface(triangle)?;
        micro.hit(&self.surface_mesh, triangle, heights, raise, ray, f64::from(limit), sides)
    }

    /// Returns the displaced surfaces that are traced, with the number of triangles of the mesh below each.
    pub(crate) fn micro_surfaces(&self) -> impl Iterator<Item = (usize, &MicroSurface, usize)> {
        let ends = self.instances.iter().skip(1).map(|next| next.first_triangle as usize).chain([self.owner.len()]);
        self.instances.iter().zip(ends).enumerate().filter_map(|(object, (instance, end))| {
            Some((object, instance.micro.as_ref()?, end - instance.first_triangle as usize))
        })
    }

    /// Returns the object that a triangle belongs to, and the triangle of its mesh that it is part of.
    pub(crate) fn place_in_scene(&self, triangle: u32) -> [u32; 2] {
        let object = self.owner[triangle as usize];
        let instance = &self.instances[object as usize];
        [object, (triangle - instance.first_triangle) / instance.pieces.max(1)]
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

/// Returns the surface that is traced over an object's triangles, if its relief asks for one.
fn micro_surface(mesh: &SurfaceMesh, instance: &Instance, material: &MaterialShading) -> Option<MicroSurface> {
    let per_texel = material.relief.vertices_per_texel.filter(|_| material.is_displaced())?;
    let map = material.heights.as_ref()?.size();
    let addressing = material.addressing(instance.repeat);
    Some(MicroSurface::new(
        mesh,
        instance.first_triangle,
        map,
        instance.depth,
        material.midlevel,
        addressing,
        per_texel,
    ))
}
