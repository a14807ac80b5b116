use glam::Vec3;

/// A ray through a pixel.
pub(crate) struct ViewRay<'a> {
    pub(crate) origin: Vec3,
    /// Unit length.
    pub(crate) direction: Vec3,
    /// Origins and directions of the rays through the next pixels to the right and below: evaluated only where maps have
    /// levels.
    pub(crate) neighbours: &'a dyn Fn() -> [[Vec3; 2]; 2],
    /// Distance before which nothing is drawn, scene units.
    pub(crate) near: f32,
    /// Distance in texels by which displaced surfaces that are not kept are moved along their normals.
    pub(crate) raise: f64,
}

/// Cost of the marches of one ray.
#[derive(Clone, Copy, Default)]
pub(crate) struct MarchCost {
    pub(crate) fetches: u32,
    pub(crate) iterations: u32,
}
