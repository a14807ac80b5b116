use glam::{DMat3, DVec3};

use super::base_triangle::{BaseTriangle, Corner};
use super::local_box::{LocalRay, Shear};
use super::micro_ray::MicroRay;

/// The sides of a surface that a ray meets.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sides {
    /// Only those turned towards the ray's origin.
    Front,
    /// Both; the first one found is enough.
    Any,
}

/// The point where a ray meets the displaced surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MicroHit {
    /// Distance in units of the ray's direction.
    pub(crate) t: f64,
    /// Weights of the corners of the mesh's triangle; they sum to 1.
    pub(crate) weights: [f64; 3],
    pub(crate) point: DVec3,
    /// Normal of the micro-triangle, towards its front; unit length.
    pub(crate) normal: DVec3,
}

/// The search of a ray in one triangle of the mesh.
pub(super) struct Search<'a> {
    triangle: &'a BaseTriangle<'a>,
    axes: DMat3,
    ray: &'a MicroRay,
    local: LocalRay,
    sides: Sides,
    /// Distance of the nearest hit so far, or beyond which none is looked for.
    limit: f64,
    best: Option<MicroHit>,
}

impl<'a> Search<'a> {
    /// Returns the first hit in a triangle nearer than `limit`.
    pub(super) fn first(
        triangle: &'a BaseTriangle<'a>,
        ray: &'a MicroRay,
        limit: f64,
        sides: Sides,
    ) -> Option<MicroHit> {
        let axes = triangle.axes();
        let local = LocalRay::new(ray, &axes, triangle.centre());
        let mut this = Self { triangle, axes, ray, local, sides, limit, best: None };
        let corners = triangle.base_corners().map(|weights| triangle.corner(&axes, weights));
        let size = triangle.n();
        if this.local.enters(&triangle.around(&corners, size, Shear::NONE), limit).is_some() {
            this.visit(&corners, size);
        }
        this.best
    }

    /// Looks for a nearer hit in the part of the triangle between three places that are `size` apart.
    fn visit(&mut self, corners: &[Corner; 3], size: u32) {
        if size == 1 {
            self.meet(corners);
            return;
        }
        let half = size / 2;
        let [a, b, c] = corners;
        let middle = |a: &Corner, b: &Corner| {
            self.triangle.corner(&self.axes, [0, 1, 2].map(|k| (a.weights[k] + b.weights[k]) / 2))
        };
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        let parts = [[*a, ab, ca], [ab, *b, bc], [ca, bc, *c], [ab, bc, ca]];
        let shear = Shear::upright([a.normal, b.normal, c.normal]);
        let local = self.local.sheared(shear);
        let mut entries = parts
            .each_ref()
            .map(|part| local.enters(&self.triangle.around(part, half, shear), self.limit).unwrap_or(f64::INFINITY));
        for _ in 0..4 {
            let nearest = (1..4).fold(0, |best, k| if entries[k] < entries[best] { k } else { best });
            if !(entries[nearest] <= self.limit && entries[nearest] < f64::INFINITY) {
                return;
            }
            entries[nearest] = f64::INFINITY;
            self.visit(&parts[nearest], half);
            if self.sides == Sides::Any && self.best.is_some() {
                return;
            }
        }
    }

    /// Intersects a micro-triangle.
    fn meet(&mut self, corners: &[Corner; 3]) {
        let points = corners.map(|corner| self.triangle.point(corner.weights));
        let Some((t, w)) = self.ray.hit(points).filter(|(t, _)| *t < self.limit) else { return };
        let normal = (points[1] - points[0]).cross(points[2] - points[0]);
        if self.sides == Sides::Front && !(normal.dot(self.ray.direction) < 0.0) {
            return;
        }
        let places = corners.map(|corner| self.triangle.fractions(corner.weights));
        let weights = [0, 1, 2].map(|k| places[0][k] * w[0] + places[1][k] * w[1] + places[2][k] * w[2]);
        if !self.triangle.is_in_bounds(weights) {
            return;
        }
        self.limit = t;
        self.best = Some(MicroHit {
            t,
            weights: self.triangle.base_weights(weights),
            point: points[0] * w[0] + points[1] * w[1] + points[2] * w[2],
            normal: normal.normalize_or_zero(),
        });
    }
}
