use glam::{DVec3, Vec3};

/// A camera: perspective or orthographic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Kind of projection.
    pub kind: CameraKind,
    /// Position of the eye, scene units.
    pub position: Vec3,
    /// Point in the middle of the picture, scene units; never the position itself.
    pub target: Vec3,
    /// Up direction of the picture; never along the view direction.
    pub up: Vec3,
    /// Perspective: vertical field of view, degrees, in (0, 180).
    pub vertical_fov: f32,
    /// Orthographic: height of the picture, scene units, > 0.
    pub size: f32,
    /// Distance of the near plane, scene units, > 0: nothing nearer is drawn.
    pub near: f32,
}

/// The kind of a [`Camera`]'s projection.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CameraKind {
    /// Rays from one point: far things are small.
    #[default]
    Perspective,
    /// Parallel rays: things are as large at any distance.
    Orthographic,
}

/// The part of an orthographic camera's way that the scene lies in, scene units along the view.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ParallelRange {
    /// The empty way before it, at most: rays that begin there instead of at the eye are as exact from any distance.
    pub skipped: f32,
    /// The length of the rest.
    pub far: f32,
}

impl CameraKind {
    /// Every kind with its name in scene files.
    pub const ALL: [(&'static str, Self); 2] =
        [("perspective", Self::Perspective), ("orthographic", Self::Orthographic)];

    /// Returns its name in scene files.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::ALL[self as usize].0
    }
}

impl Camera {
    /// Returns true if all rays are parallel.
    #[must_use]
    pub fn is_orthographic(&self) -> bool {
        self.kind == CameraKind::Orthographic
    }

    /// Returns the picture's right and up and the view direction, of unit length; 0 if the camera has none.
    #[must_use]
    pub fn axes(&self) -> [Vec3; 3] {
        let forward = (self.target - self.position).normalize_or_zero();
        let right = forward.cross(self.up).normalize_or_zero();
        [right, right.cross(forward), forward]
    }

    /// Returns half the height of what is seen: of a perspective camera at distance 1, of an orthographic one at any.
    #[must_use]
    pub fn half_height(&self) -> f32 {
        match self.kind {
            CameraKind::Perspective => (self.vertical_fov.to_radians() * 0.5).tan(),
            CameraKind::Orthographic => 0.5 * self.size,
        }
    }

    /// Returns the part of an orthographic camera's way in which a scene within these corners lies, with room for its
    /// reliefs. Of a perspective camera there is nothing to skip.
    #[must_use]
    pub fn parallel_range(&self, [min, max]: [Vec3; 2]) -> ParallelRange {
        if !self.is_orthographic() {
            return ParallelRange::default();
        }
        let eye = self.position.as_dvec3();
        let forward = (self.target.as_dvec3() - eye).normalize_or_zero();
        let [min, max] = [min, max].map(|corner| corner.as_dvec3() - eye);
        let (a, b) = (min * forward, max * forward);
        let (front, back) = (a.min(b).element_sum(), a.max(b).element_sum());
        let room = 2.0 * min.distance(max);
        let skipped = (front - room).max(0.0) as f32;
        ParallelRange { skipped, far: (back + room - f64::from(skipped)).max(f64::from(self.near)) as f32 }
    }

    /// Returns the point from which an orthographic camera's rays begin if they skip a part of their way.
    #[must_use]
    pub fn eye_after(&self, skipped: f32) -> Vec3 {
        if skipped == 0.0 {
            return self.position;
        }
        let eye = self.position.as_dvec3();
        let forward: DVec3 = (self.target.as_dvec3() - eye).normalize_or_zero();
        (eye + forward * f64::from(skipped)).as_vec3()
    }
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            kind: CameraKind::Perspective,
            position: Vec3::new(0.0, 0.0, 3.0),
            target: Vec3::ZERO,
            up: Vec3::Y,
            vertical_fov: 45.0,
            size: 2.0,
            near: 0.01,
        }
    }
}
