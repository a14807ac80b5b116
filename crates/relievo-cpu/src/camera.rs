use glam::Vec3;
use relievo_scene::Camera;

/// Generator of camera rays.
pub(crate) struct CameraRays {
    position: Vec3,
    pub(crate) forward: Vec3,
    /// Half the picture's width and height: on the plane at distance 1, or at any if rays are parallel.
    right: Vec3,
    up: Vec3,
    pixel: [f32; 2],
    pub(crate) near: f32,
    parallel: bool,
    /// The empty way between the eye and where parallel rays begin.
    pub(crate) skipped: f32,
}

impl CameraRays {
    /// `bounds`: the corners of the scene.
    pub(crate) fn new(camera: &Camera, bounds: [Vec3; 2], width: u32, height: u32) -> Self {
        let [right, up, forward] = camera.axes();
        let half = camera.half_height();
        let aspect = width as f32 / height as f32;
        let skipped = camera.parallel_range(bounds).skipped;
        Self {
            position: camera.eye_after(skipped),
            forward,
            right: right * (half * aspect),
            up: up * half,
            pixel: [2.0 / width as f32, 2.0 / height as f32],
            near: camera.near - skipped,
            parallel: camera.is_orthographic(),
            skipped,
        }
    }

    /// Returns origin and direction (unit length) of the ray through a point of the picture, in pixels from its top left.
    pub(crate) fn ray(&self, x: f32, y: f32) -> [Vec3; 2] {
        let (right, up) = (self.right * (x * self.pixel[0] - 1.0), self.up * (1.0 - y * self.pixel[1]));
        if self.parallel {
            return [self.position + right + up, self.forward];
        }
        [self.position, (self.forward + right + up).normalize()]
    }
}
