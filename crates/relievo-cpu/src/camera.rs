use glam::Vec3;
use relievo_scene::Camera;

/// Generator of camera rays.
pub(crate) struct CameraRays {
    pub(crate) position: Vec3,
    pub(crate) forward: Vec3,
    /// Half the picture's width and height on the plane at distance 1.
    right: Vec3,
    up: Vec3,
    pixel: [f32; 2],
    pub(crate) near: f32,
}

impl CameraRays {
    pub(crate) fn new(camera: &Camera, width: u32, height: u32) -> Self {
        let forward = (camera.target - camera.position).normalize();
        let right = forward.cross(camera.up).normalize();
        let up = right.cross(forward);
        let half = (camera.vertical_fov.to_radians() * 0.5).tan();
        let aspect = width as f32 / height as f32;
        Self {
            position: camera.position,
            forward,
            right: right * (half * aspect),
            up: up * half,
            pixel: [2.0 / width as f32, 2.0 / height as f32],
            near: camera.near,
        }
    }

    /// Returns the direction (unit length) through a point of the picture, in pixels from its top left.
    pub(crate) fn direction(&self, x: f32, y: f32) -> Vec3 {
        (self.forward + self.right * (x * self.pixel[0] - 1.0) + self.up * (1.0 - y * self.pixel[1])).normalize()
    }
}
