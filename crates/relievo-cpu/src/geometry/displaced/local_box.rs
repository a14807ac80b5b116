use glam::{DMat3, DVec2, DVec3};

use super::micro_ray::MicroRay;

/// A ray in the axes in which a triangle's boxes stand.
#[derive(Clone, Copy)]
pub(super) struct LocalRay {
    origin: DVec3,
    direction: DVec3,
    inverse: DVec3,
}

impl LocalRay {
    /// Turns a ray by `axes`, whose rows are the local axes.
    pub(super) fn new(ray: &MicroRay, axes: &DMat3, centre: DVec3) -> Self {
        let direction = *axes * ray.direction;
        Self { origin: *axes * (ray.origin - centre), direction, inverse: direction.recip() }
    }

    /// Returns the ray in sheared axes.
    pub(super) fn sheared(&self, shear: Shear) -> Self {
        if shear.0 == DVec2::ZERO {
            return *self;
        }
        let direction = shear.of(self.direction);
        Self { origin: shear.of(self.origin), direction, inverse: direction.recip() }
    }

    /// Returns the distance at which the ray enters a box, if it does so before `limit`.
    #[inline]
    pub(super) fn enters(&self, around: &LocalBox, limit: f64) -> Option<f64> {
        let (a, b) = ((around.min - self.origin) * self.inverse, (around.max - self.origin) * self.inverse);
        // A ray along a side: 0 · ∞ is NaN, which `max` and `min` of numbers leave out.
        let (mut near, mut far) = (0.0f64, limit);
        for k in 0..3 {
            near = near.max(a[k].min(b[k]));
            far = far.min(a[k].max(b[k]));
        }
        // Rounding of the distances.
        (near <= far + 1e-12 * far.abs().min(1e300)).then_some(near)
    }
}

/// A shear of the local axes that sets slanted columns upright, so that boxes around them are slim.
#[derive(Clone, Copy)]
pub(super) struct Shear(DVec2);

impl Shear {
    /// Axes as they are.
    pub(super) const NONE: Self = Self(DVec2::ZERO);

    /// Returns the shear that sets the mean of these directions upright; none where it lies too flat.
    pub(super) fn upright(directions: [DVec3; 3]) -> Self {
        let mean = directions[0] + directions[1] + directions[2];
        if mean.z > 0.2 * mean.length() { Self(mean.truncate() / mean.z) } else { Self::NONE }
    }

    fn of(self, v: DVec3) -> DVec3 {
        DVec3::new(v.x - self.0.x * v.z, v.y - self.0.y * v.z, v.z)
    }
}

/// A box.
#[derive(Clone, Copy)]
pub(super) struct LocalBox {
    pub(super) min: DVec3,
    pub(super) max: DVec3,
}

impl LocalBox {
    /// Returns the box around all points p + o·n with p in the triangle of `points`, o in `offsets` and n a unit vector between
    /// the three `normals`, in sheared axes; `slack` is added on all sides.
    pub(super) fn around(points: [DVec3; 3], normals: [DVec3; 3], offsets: [f64; 2], shear: Shear, slack: f64) -> Self {
        let min_of = |v: [DVec3; 3]| v[0].min(v[1]).min(v[2]);
        let max_of = |v: [DVec3; 3]| v[0].max(v[1]).max(v[2]);
        let bulge = bulge(normals);
        // A shear lengthens what lies between the vectors and the flat triangle, along x and y.
        let stretch = DVec3::new(1.0 + shear.0.x.abs(), 1.0 + shear.0.y.abs(), 1.0);
        let (points, normals) = (points.map(|p| shear.of(p)), normals.map(|n| shear.of(n)));
        let (low, high) = if bulge < 1.0 {
            (min_of(normals) - stretch * bulge, max_of(normals) + stretch * bulge)
        } else {
            (-stretch, stretch)
        };
        let slack = stretch * slack;
        let [least, most] = offsets;
        let ends = [low * least, high * least, low * most, high * most];
        let down = ends[0].min(ends[1]).min(ends[2]).min(ends[3]);
        let up = ends[0].max(ends[1]).max(ends[2]).max(ends[3]);
        Self { min: min_of(points) + down - slack, max: max_of(points) + up + slack }
    }
}

/// Returns how far unit vectors between three others may lie from the flat triangle of these; 1 or more if anywhere.
///
/// A weighted mean v of unit vectors whose cosines are at least c has |v|² ≥ c + (1 − c)/3, and lies 1 − |v| inside the sphere.
fn bulge(n: [DVec3; 3]) -> f64 {
    if n[0] == n[1] && n[1] == n[2] {
        return if n[0] == DVec3::ZERO { 1.0 } else { 0.0 };
    }
    let cos = n[0].dot(n[1]).min(n[1].dot(n[2])).min(n[2].dot(n[0]));
    let squared = cos + (1.0 - cos) / 3.0;
    // Written so that NaN gives 1.
    if squared > 0.0 && n.iter().all(|n| n.length_squared() > 0.5) {
        1.0 - squared.min(1.0).sqrt() + 1e-15
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_box_holds_the_surface_between_the_normals() {
        let points = [DVec3::ZERO, DVec3::X, DVec3::Y];
        for spread in [0.0, 0.1, 0.7, 1.5, 4.0] {
            let normals = [DVec3::new(-1.0, 0.3, 0.0), DVec3::new(0.8, -0.2, 0.0), DVec3::new(0.1, 0.9, 0.0)]
                .map(|lean| (DVec3::Z + lean * spread).normalize());
            for (k, offsets) in [[-0.3, -0.1], [-0.2, 0.4], [0.1, 0.5]].into_iter().enumerate() {
                let shear = if k == 0 { Shear::NONE } else { Shear::upright(normals) };
                let around = LocalBox::around(points, normals, offsets, shear, 0.0);
                for a in 0..=20 {
                    for b in 0..=20 - a {
                        let w = [a, b, 20 - a - b].map(|w| f64::from(w) / 20.0);
                        let sum = |v: [DVec3; 3]| (0..3).map(|k| v[k] * w[k]).sum::<DVec3>();
                        for o in offsets {
                            let p = shear.of(sum(points) + sum(normals).normalize() * o);
                            let inside = (p - around.min).min(around.max - p).min_element();
                            assert!(inside > -1e-12, "{spread} {offsets:?} {w:?}: {inside}");
                        }
                    }
                }
            }
        }
    }
}
