use relievo_cpu::VisiblePoint;
use relievo_map::Grid;
use relievo_march::Technique;
use relievo_scene::{MarchSpace, Object, Scene, SurfaceMesh, SurfaceTechnique};

/// The pixels in which a technique may show relief: those that its flat polygons cover, and where a relief has an outline of its
/// own also those that it, or the truth, reaches beyond them.
pub(crate) struct JudgedPixels {
    polygons: Grid<bool>,
    /// For each object, true if its relief has an outline of its own.
    outlined: Vec<bool>,
}

impl JudgedPixels {
    /// Makes the pixels of a scene, of which its flat polygons show in these.
    pub(crate) fn new(scene: &Scene, polygons: Grid<bool>) -> Self {
        Self { polygons, outlined: scene.objects.iter().map(|object| has_outline(scene, object)).collect() }
    }

    pub(crate) fn size(&self) -> [u32; 2] {
        [self.polygons.width(), self.polygons.height()]
    }

    /// Returns true if a pixel that shows this point is judged.
    pub(crate) fn contains(&self, x: u32, y: u32, point: Option<&VisiblePoint>) -> bool {
        *self.polygons.get(x, y) || point.is_some_and(|point| self.outlined[point.object as usize])
    }

    /// Returns true if a relief reaches beyond its polygons.
    pub(crate) fn reach_beyond_polygons(&self) -> bool {
        self.outlined.contains(&true)
    }
}

/// Returns true if the exact march of an object's relief is in shells, which reach beyond its polygons.
fn has_outline(scene: &Scene, object: &Object) -> bool {
    let mut material = scene.materials[object.material].clone();
    material.relief.technique = SurfaceTechnique::Marched(Technique::Exact);
    SurfaceMesh::in_scene_space(object, &material).march_space(&material) == MarchSpace::Shell
}
