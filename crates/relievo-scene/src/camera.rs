use glam::Vec3;

/// A pinhole camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The eye, in scene units.
    pub position: Vec3,
    /// The point in the middle of the picture; never the eye itself.
    pub target: Vec3,
    /// Which way is up in the picture; never along the line of sight.
    pub up: Vec3,
    /// Angle between the lower and the upper border, degrees, in (0, 180).
    pub vertical_fov: f32,
    /// Nothing nearer than this is drawn, scene units, > 0.
    pub near: f32,
}

impl Default for Camera {
    fn default() -> Self {
        Self { position: Vec3::new(0.0, 0.0, 3.0), target: Vec3::ZERO, up: Vec3::Y, vertical_fov: 45.0, near: 0.01 }
    }
}
