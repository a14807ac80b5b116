use glam::Vec3;

/// A ray made ready for watertight triangle tests (Woop, Benthin and Wald 2013): it is sheared onto the z axis, so that
/// neighbouring triangles decide about their common edge with the same numbers.
#[derive(Clone, Copy)]
pub(crate) struct ShearedRay {
    origin: Vec3,
    axes: [usize; 3],
    shear: Vec3,
}

/// The point where a ray meets a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TriangleHit {
    /// Distance in units of the ray's direction.
    pub(crate) t: f32,
    /// Weights of the three corners; they sum to 1.
    pub(crate) weights: [f32; 3],
}

impl ShearedRay {
    pub(crate) fn new(origin: Vec3, direction: Vec3) -> Self {
        let a = direction.abs();
        let z = if a.x > a.y && a.x > a.z {
            0
        } else if a.y > a.z {
            1
        } else {
            2
        };
        let (mut x, mut y) = ((z + 1) % 3, (z + 2) % 3);
        // Keeps the triangles' winding.
        if direction[z] < 0.0 {
            std::mem::swap(&mut x, &mut y);
        }
        let shear = Vec3::new(direction[x] / direction[z], direction[y] / direction[z], 1.0 / direction[z]);
        Self { origin, axes: [x, y, z], shear }
    }

    /// Intersects a triangle from either side, in front of the origin.
    pub(crate) fn hit(&self, corners: [Vec3; 3]) -> Option<TriangleHit> {
        let [kx, ky, kz] = self.axes;
        let p = corners.map(|corner| {
            let q = corner - self.origin;
            [q[kx] - self.shear.x * q[kz], q[ky] - self.shear.y * q[kz], self.shear.z * q[kz]]
        });
        let edge = |a: [f32; 3], b: [f32; 3]| {
            let value = a[0] * b[1] - a[1] * b[0];
            if value == 0.0 {
                // On the edge as far as f32 can tell: f64 decides.
                (f64::from(a[0]) * f64::from(b[1]) - f64::from(a[1]) * f64::from(b[0])) as f32
            } else {
                value
            }
        };
        let w = [edge(p[2], p[1]), edge(p[0], p[2]), edge(p[1], p[0])];
        if w.iter().any(|&w| w < 0.0) && w.iter().any(|&w| w > 0.0) {
            return None;
        }
        let det = w[0] + w[1] + w[2];
        if det == 0.0 {
            return None;
        }
        let weights = w.map(|w| w / det);
        let t = weights[0] * p[0][2] + weights[1] * p[1][2] + weights[2] * p[2][2];
        (t > 0.0).then_some(TriangleHit { t, weights })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_ray_slips_between_two_triangles() {
        let corners = [
            Vec3::new(-1.0, -1.0, 0.3),
            Vec3::new(1.0, -0.9, -0.2),
            Vec3::new(1.1, 1.0, 0.1),
            Vec3::new(-1.0, 1.0, 0.0),
        ];
        let origin = Vec3::new(0.21, 0.13, 3.0);
        for i in 0..10_000 {
            // Points on the common diagonal, as exactly as f32 can say.
            let target = corners[0].lerp(corners[2], i as f32 / 10_000.0 * 0.998 + 0.001);
            let ray = ShearedRay::new(origin, (target - origin).normalize());
            let first = ray.hit([corners[0], corners[1], corners[2]]);
            let second = ray.hit([corners[0], corners[2], corners[3]]);
            assert!(first.is_some() || second.is_some(), "point {i} of the diagonal");
        }
    }

    #[test]
    fn both_sides_are_hit_and_weights_give_the_point() {
        let corners = [Vec3::new(0.0, 0.0, 1.0), Vec3::new(2.0, 0.0, 1.0), Vec3::new(0.0, 2.0, 1.0)];
        for (origin, direction) in [(Vec3::new(0.5, 0.25, 0.0), Vec3::Z), (Vec3::new(0.5, 0.25, 2.0), Vec3::NEG_Z)] {
            let hit = ShearedRay::new(origin, direction).hit(corners).unwrap();
            let point = (0..3).map(|k| corners[k] * hit.weights[k]).sum::<Vec3>();
            assert!((hit.t - 1.0).abs() < 1e-6 && (point - (origin + direction)).length() < 1e-6);
        }
        assert!(ShearedRay::new(Vec3::new(0.5, 0.25, 2.0), Vec3::Z).hit(corners).is_none());
    }
}
