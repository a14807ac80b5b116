use glam::{DVec3, Vec3};

/// A ray in f64 made ready for watertight triangle tests (Woop, Benthin and Wald 2013).
#[derive(Clone, Copy)]
pub(crate) struct MicroRay {
    pub(super) origin: DVec3,
    pub(super) direction: DVec3,
    /// Distance before which nothing is met.
    near: f64,
    axes: [usize; 3],
    shear: DVec3,
}

impl MicroRay {
    /// Makes a ray that meets nothing nearer than `near`.
    pub(crate) fn new(origin: Vec3, direction: Vec3, near: f32) -> Self {
        Self { near: f64::from(near), ..Self::through(origin.as_dvec3(), direction.as_dvec3()) }
    }

    pub(super) fn through(origin: DVec3, direction: DVec3) -> Self {
        let a = direction.abs();
        let z = if a.x > a.y && a.x > a.z {
            0
        } else if a.y > a.z {
            1
        } else {
            2
        };
        let (x, y) = ((z + 1) % 3, (z + 2) % 3);
        let shear = DVec3::new(direction[x] / direction[z], direction[y] / direction[z], 1.0 / direction[z]);
        Self { origin, direction, near: 0.0, axes: [x, y, z], shear }
    }

    /// Intersects a triangle from either side, beyond the near distance: distance, and weights that sum to 1. A ray through an
    /// edge meets both triangles at it.
    pub(super) fn hit(&self, corners: [DVec3; 3]) -> Option<(f64, [f64; 3])> {
        let [kx, ky, kz] = self.axes;
        let p = corners.map(|corner| {
            let q = corner - self.origin;
            [q[kx] - self.shear.x * q[kz], q[ky] - self.shear.y * q[kz], self.shear.z * q[kz]]
        });
        let edge = |a: [f64; 3], b: [f64; 3]| a[0] * b[1] - a[1] * b[0];
        let w = [edge(p[2], p[1]), edge(p[0], p[2]), edge(p[1], p[0])];
        if w.iter().any(|&w| w < 0.0) && w.iter().any(|&w| w > 0.0) {
            return None;
        }
        let det = w[0] + w[1] + w[2];
        if !(det.abs() > 0.0) {
            return None;
        }
        let weights = w.map(|w| w / det);
        let t = weights[0] * p[0][2] + weights[1] * p[1][2] + weights[2] * p[2][2];
        (t > 0.0 && t >= self.near).then_some((t, weights))
    }
}
