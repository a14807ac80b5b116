use relievo_scene::{MarchSpace, ReliefDepth};

use super::displaced::MicroSurface;

/// An object of the scene.
pub(crate) struct Instance {
    /// Index into [`World::materials`].
    pub(crate) material: usize,
    /// The same in the scene, where both sides of a material are one.
    pub(crate) scene_material: usize,
    /// Of the back of a relief, the instance that is its front.
    pub(crate) front: Option<u32>,
    pub(crate) depth: ReliefDepth,
    pub(crate) space: MarchSpace,
    /// The object of the scene.
    pub(super) object: u32,
    /// The first of its triangles.
    pub(super) first_triangle: u32,
    /// Triangles that each triangle of its mesh was cut into.
    pub(super) pieces: u32,
    /// The surface that is traced over its triangles instead of these.
    pub(super) micro: Option<MicroSurface>,
}
