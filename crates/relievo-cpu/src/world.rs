use glam::Vec2;
use relievo_scene::{Patchwork, ReliefDepth, Scene, Vertex};

use crate::RenderError;
use crate::bvh::{Bounds, Tree};
use crate::material::Look;

/// More than this would take over 4 GB of memory.
const MAX_TRIANGLES: u64 = 16_000_000;

/// An object as the renderer sees it.
pub(crate) struct Thing {
    pub(crate) look: usize,
    /// Upper corner of the texture range: the lower one is (0, 0).
    pub(crate) repeat: Vec2,
    pub(crate) depth: ReliefDepth,
}

/// Everything that can be hit.
pub(crate) struct World {
    pub(crate) looks: Vec<Look>,
    pub(crate) things: Vec<Thing>,
    pub(crate) patchwork: Patchwork,
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
        let looks: Vec<Look> =
            scene.materials.iter().map(|material| Look::new(material, scene.shading.color_space)).collect();
        let mut patchwork = Patchwork::default();
        let mut owner = Vec::new();
        let mut things = Vec::new();
        for (index, object) in scene.objects.iter().enumerate() {
            let look = &looks[object.material];
            let thing =
                Thing { look: object.material, repeat: object.uv_repeat, depth: ReliefDepth::new(look.range, object) };
            let mut part = Patchwork::placed(object);
            let grid = if look.is_displaced() { look.relief.grid } else { 1 };
            let triangles = owner.len() as u64 + part.displaced_count(grid, object.uv_repeat);
            if triangles > MAX_TRIANGLES {
                return Err(RenderError::TooManyTriangles { object: index, triangles, grid, max: MAX_TRIANGLES });
            }
            if let Some(heights) = look.heights.as_ref().filter(|_| look.is_displaced()) {
                let field = look.field(heights, 0.0, object.uv_repeat);
                part = part.displaced(&field, &thing.depth, look.midlevel, grid, object.uv_repeat);
            }
            let offset = patchwork.vertices.len() as u32;
            owner.resize(owner.len() + part.triangles.len(), things.len() as u32);
            patchwork.triangles.extend(part.triangles.iter().map(|t| t.map(|i| i + offset)));
            patchwork.vertices.append(&mut part.vertices);
            things.push(thing);
        }
        let tree_of = |risen: bool| {
            let chosen = |triangle: &u32| looks[things[owner[*triangle as usize] as usize].look].is_risen() == risen;
            let triangles: Vec<u32> = (0..owner.len() as u32).filter(chosen).collect();
            let corners = |&t: &u32| patchwork.triangles[t as usize].map(|i| patchwork.vertices[i as usize].position);
            let bounds: Vec<Bounds> = triangles.iter().map(|t| Bounds::around(corners(t))).collect();
            Tree::build(&bounds, &triangles)
        };
        let (tree, risen) = (tree_of(false), tree_of(true));
        Ok(Self { looks, things, patchwork, owner, tree, risen })
    }

    /// Index of the material of a triangle.
    pub(crate) fn material_of(&self, triangle: u32) -> u32 {
        self.things[self.owner[triangle as usize] as usize].look as u32
    }

    pub(crate) fn corners(&self, triangle: u32) -> [&Vertex; 3] {
        self.patchwork.triangles[triangle as usize].map(|i| &self.patchwork.vertices[i as usize])
    }

    pub(crate) fn thing_of(&self, triangle: u32) -> (&Thing, &Look) {
        let thing = &self.things[self.owner[triangle as usize] as usize];
        (thing, &self.looks[thing.look])
    }
}
