use glam::Vec3;

/// A pinhole camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Position of the eye, scene units.
    pub position: Vec3,
    /// Point in the middle of the picture, scene units; never the position itself.
    pub target: Vec3,
    /// Up direction of the picture; never along the view direction.
    pub up: Vec3,
    /// Vertical field of view, degrees, in (0, 180).
    pub vertical_fov: f32,
    /// Distance of the near plane, scene units, > 0: nothing nearer is drawn.
    pub near: f32,
}

impl Default for Camera {
    fn default() -> Self {
        Self { position: Vec3::new(0.0, 0.0, 3.0), target: Vec3::ZERO, up: Vec3::Y, vertical_fov: 45.0, near: 0.01 }
    }
}
