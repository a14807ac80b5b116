use relievo_scene::{ReliefDepth, Scene, SurfaceMesh};

use super::displaced::{MicroSurface, TracedRelief};
use super::instance::Instance;
use crate::RenderError;
use crate::shading::material::MaterialShading;

/// Puts the objects of a scene together.
pub(super) struct WorldBuilder<'a> {
    scene: &'a Scene,
    pub(super) materials: Vec<MaterialShading>,
    /// Of each material of the scene the index of its back, if one has to be marched.
    backs: Vec<Option<usize>>,
    pub(super) instances: Vec<Instance>,
    pub(super) surface_mesh: SurfaceMesh,
    pub(super) owner: Vec<u32>,
    pub(super) triangles: usize,
}

impl<'a> WorldBuilder<'a> {
    /// Makes the materials ready; `known` are those of a scene that may have the same maps.
    pub(super) fn new(scene: &'a Scene, known: &[MaterialShading]) -> Self {
        let space = scene.shading.color_space;
        let made = |(number, material)| MaterialShading::new(material, space, known.get(number));
        let mut materials: Vec<MaterialShading> = scene.materials.iter().enumerate().map(made).collect();
        let mut backs = vec![None; materials.len()];
        for (number, material) in scene.materials.iter().enumerate() {
            if material.has_marched_back() {
                backs[number] = Some(materials.len());
                materials.push(materials[number].back(material, space, known.get(materials.len())));
            }
        }
        let (instances, owner) = (Vec::new(), Vec::new());
        Self { scene, materials, backs, instances, surface_mesh: SurfaceMesh::default(), owner, triangles: 0 }
    }

    /// Adds an object, and the back of its relief if that can be seen.
    pub(super) fn add(&mut self, index: usize) -> Result<(), RenderError> {
        let object = &self.scene.objects[index];
        let (number, repeat) = (object.material, object.uv_repeat);
        let (in_scene, material) = (&self.scene.materials[number], &self.materials[number]);
        let depth = ReliefDepth::new(material.range, object);
        let mut part = SurfaceMesh::in_scene_space(object, in_scene);
        let space = part.march_space(in_scene);
        let first_triangle = self.owner.len() as u32;
        let micro = micro_surface(&part, first_triangle, depth, material);
        let keeps_grid = material.is_displaced() && micro.is_none();
        let grid = if keeps_grid { material.relief.grid } else { 1 };
        let uvs = in_scene.uv.after(repeat);
        let sides = 1 + u64::from(self.backs[number].is_some());
        let triangles = self.owner.len() as u64 + part.displaced_count(grid, &uvs) * sides;
        if triangles > SurfaceMesh::MAX_TRIANGLES {
            return Err(RenderError::TooManyTriangles {
                object: index,
                triangles,
                grid,
                max: SurfaceMesh::MAX_TRIANGLES,
            });
        }
        let count = part.triangles.len().max(1);
        if let Some(heights) = material.heights.as_deref().filter(|_| keeps_grid) {
            let field = material.field(heights, 0.0, part.texture_range());
            part = part.displaced(&field, &depth, material.midlevel, grid, &uvs);
        }
        let pieces = (part.triangles.len() / count) as u32;
        let instance =
            |material: usize, front: Option<u32>, first_triangle: u32, micro: Option<MicroSurface>| Instance {
                material,
                scene_material: number,
                front,
                depth,
                space,
                object: index as u32,
                first_triangle,
                pieces,
                micro,
            };
        let sides_triangles = part.triangles.len() as u32;
        self.triangles += part.triangles.len();
        let front = self.instances.len() as u32;
        let back = self.backs[number]
            .map(|back| (part.back(), instance(back, Some(front), first_triangle + sides_triangles, None)));
        self.push(part, instance(number, None, first_triangle, micro));
        if let Some((part, instance)) = back {
            self.push(part, instance);
        }
        Ok(())
    }

    fn push(&mut self, mut part: SurfaceMesh, instance: Instance) {
        self.owner.resize(self.owner.len() + part.triangles.len(), self.instances.len() as u32);
        self.surface_mesh.append(&mut part);
        self.instances.push(instance);
    }
}

/// Returns the surface that is traced over an object's triangles, if its relief asks for one.
fn micro_surface(
    mesh: &SurfaceMesh,
    first_triangle: u32,
    depth: ReliefDepth,
    material: &MaterialShading,
) -> Option<MicroSurface> {
    let per_texel = material.relief.vertices_per_texel.filter(|_| material.is_displaced())?;
    let heights = material.heights.as_ref()?;
    let traced = TracedRelief {
        map: heights.size(),
        depth,
        midlevel: material.midlevel,
        wrap: material.wrap(),
        nearest: heights.is_sampled_nearest(),
        relief: material.relief,
        per_texel,
    };
    Some(MicroSurface::new(mesh, first_triangle, traced))
}
