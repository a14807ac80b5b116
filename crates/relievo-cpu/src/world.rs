use glam::Vec2;
use relievo_scene::{ReliefDepth, Scene, SurfaceMesh, Vertex};

use crate::RenderError;
use crate::bvh::{Bounds, Tree};
use crate::material::MaterialShading;

/// More than this would take over 4 GB of memory.
const MAX_TRIANGLES: u64 = 16_000_000;

/// An object as the renderer sees it.
pub(crate) struct Instance {
    pub(crate) look: usize,
    /// Upper corner of the texture range: the lower one is (0, 0).
    pub(crate) repeat: Vec2,
    pub(crate) depth: ReliefDepth,
}

/// Everything that can be hit.
pub(crate) struct World {
    pub(crate) looks: Vec<MaterialShading>,
    pub(crate) things: Vec<Instance>,
    pub(crate) surface_mesh: SurfaceMesh,
    /// Which thing each triangle belongs to.
    pub(crate) owner: Vec<u32>,
    /// All triangles that are the surface, or have it below them: nothing of them lies before the polygon.
    pub(crate) tree: Tree,
    /// The triangles whose relief rises above them: the surface may be far from where a ray meets the polygon, so that no
    /// distance rules one out.
    pub(crate) risen: Tree,
}

impl World {
    pub(crate) fn new(scene: &Scene) -> Result<Self, RenderError> {
        let looks: Vec<MaterialShading> =
            scene.materials.iter().map(|material| MaterialShading::new(material, scene.shading.color_space)).collect();
        let mut surface_mesh = SurfaceMesh::default();
        let mut owner = Vec::new();
        let mut things = Vec::new();
        for (index, object) in scene.objects.iter().enumerate() {
            let look = &looks[object.material];
            let thing = Instance {
                look: object.material,
                repeat: object.uv_repeat,
                depth: ReliefDepth::new(look.range, object),
            };
            let mut part = SurfaceMesh::in_scene_space(object);
            let grid = if look.is_displaced() { look.relief.grid } else { 1 };
            let triangles = owner.len() as u64 + part.displaced_count(grid, object.uv_repeat);
            if triangles > MAX_TRIANGLES {
                return Err(RenderError::TooManyTriangles { object: index, triangles, grid, max: MAX_TRIANGLES });
            }
            if let Some(heights) = look.heights.as_ref().filter(|_| look.is_displaced()) {
                let field = look.field(heights, 0.0, object.uv_repeat);
                part = part.displaced(&field, &thing.depth, look.midlevel, grid, object.uv_repeat);
            }
            let offset = surface_mesh.vertices.len() as u32;
            owner.resize(owner.len() + part.triangles.len(), things.len() as u32);
            surface_mesh.triangles.extend(part.triangles.iter().map(|t| t.map(|i| i + offset)));
            surface_mesh.vertices.append(&mut part.vertices);
            things.push(thing);
        }
        let tree_of = |risen: bool| {
            let chosen = |triangle: &u32| looks[things[owner[*triangle as usize] as usize].look].is_risen() == risen;
            let triangles: Vec<u32> = (0..owner.len() as u32).filter(chosen).collect();
            let corners =
                |&t: &u32| surface_mesh.triangles[t as usize].map(|i| surface_mesh.vertices[i as usize].position);
            let bounds: Vec<Bounds> = triangles.iter().map(|t| Bounds::around(corners(t))).collect();
            Tree::build(&bounds, &triangles)
        };
        let (tree, risen) = (tree_of(false), tree_of(true));
        Ok(Self { looks, things, surface_mesh, owner, tree, risen })
    }

    /// Index of the material of a triangle.
    pub(crate) fn material_of(&self, triangle: u32) -> u32 {
        self.things[self.owner[triangle as usize] as usize].look as u32
    }

    pub(crate) fn corners(&self, triangle: u32) -> [&Vertex; 3] {
        self.surface_mesh.triangles[triangle as usize].map(|i| &self.surface_mesh.vertices[i as usize])
    }

    pub(crate) fn thing_of(&self, triangle: u32) -> (&Instance, &MaterialShading) {
        let thing = &self.things[self.owner[triangle as usize] as usize];
        (thing, &self.looks[thing.look])
    }
}
