use glam::{DMat3, DVec2, DVec3};
use relievo_march::Bounds;
use relievo_scene::{ReliefDepth, Vertex};

use super::filtered_map::FilteredMap;
use super::local_box::{LocalBox, Shear};

/// Samples along a side from which the range of a triangle's depth is taken.
const DEPTH_SAMPLES: u32 = 8;

/// The relief of an object: what turns a point of its mesh into a point of the surface.
#[derive(Clone, Copy)]
pub(super) struct Displacement<'a> {
    pub(super) heights: FilteredMap<'a>,
    pub(super) depth: &'a ReliefDepth,
    pub(super) midlevel: f64,
    /// Distance by which the whole surface is moved along its normals, scene units.
    pub(super) raise: f64,
    /// Texture range beyond which there is no surface.
    pub(super) bounds: Option<Bounds>,
}

/// A triangle of the mesh, cut into micro-triangles. Places in it are three whole weights that sum to [`BaseTriangle::n`].
pub(super) struct BaseTriangle<'a> {
    relief: Displacement<'a>,
    n: u32,
    /// The corners, sorted by position: sums on an edge have the same order on both sides of it.
    corners: [&'a Vertex; 3],
    positions: [DVec3; 3],
    normals: [DVec3; 3],
    places: [DVec2; 3],
    /// Index among the mesh's corners of each sorted one.
    slots: [usize; 3],
    depth_range: DepthRange,
}

/// The depth of a relief over a triangle, scene units.
#[derive(Clone, Copy)]
pub(super) enum DepthRange {
    /// The same over the whole object: to the last bit, so that neighbours agree.
    Uniform(f64),
    /// Between these bounds.
    Between([f32; 2]),
}

impl DepthRange {
    fn bounds(self) -> [f64; 2] {
        match self {
            Self::Uniform(depth) => [depth; 2],
            Self::Between(bounds) => bounds.map(f64::from),
        }
    }
}

/// A place in a triangle, with what its boxes are made of.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    pub(super) weights: [u32; 3],
    /// In the local axes.
    point: DVec3,
    pub(super) normal: DVec3,
    place: DVec2,
    depth: f64,
}

impl<'a> BaseTriangle<'a> {
    /// Cuts the triangle between `corners` into n² micro-triangles.
    pub(super) fn new(corners: [&'a Vertex; 3], relief: Displacement<'a>, depth_range: DepthRange, n: u32) -> Self {
        let mut slots = [0, 1, 2];
        slots.sort_by(|&a, &b| {
            let key = |k: usize| [corners[k].position, corners[k].direction].map(|v| v.to_array());
            key(a).partial_cmp(&key(b)).unwrap_or(std::cmp::Ordering::Equal)
        });
        let corners = slots.map(|k| corners[k]);
        Self {
            relief,
            n,
            corners,
            positions: corners.map(|corner| corner.position.as_dvec3()),
            normals: corners.map(|corner| corner.direction.as_dvec3()),
            places: corners.map(|corner| relief.heights.place(corner.uv.as_dvec2())),
            slots,
            depth_range,
        }
    }

    pub(super) fn n(&self) -> u32 {
        self.n
    }

    /// Returns the weights of the mesh's corners, in their order.
    pub(super) fn base_corners(&self) -> [[u32; 3]; 3] {
        let mut corners = [[0; 3]; 3];
        for (k, &slot) in self.slots.iter().enumerate() {
            corners[slot][k] = self.n;
        }
        corners
    }

    /// Returns weights as those of the mesh's corners, in their order.
    pub(super) fn base_weights(&self, weights: [f64; 3]) -> [f64; 3] {
        let mut base = [0.0; 3];
        for (k, &slot) in self.slots.iter().enumerate() {
            base[slot] = weights[k];
        }
        base
    }

    /// Returns true if the relief goes as far as these weights of the sorted corners.
    pub(super) fn is_in_bounds(&self, w: [f64; 3]) -> bool {
        let Some(bounds) = self.relief.bounds else { return true };
        let uv = (0..3).map(|k| self.corners[k].uv.as_dvec2() * w[k]).sum::<DVec2>();
        let inside = |x: f64, k: usize| {
            let (min, max) = (f64::from(bounds.min[k]), f64::from(bounds.max[k]));
            // Rounding must not open a gap where a chart ends and the next one begins.
            let slack = 1e-9 * (1.0 + x.abs());
            x >= min - slack && x <= max + slack
        };
        inside(uv.x, 0) && inside(uv.y, 1)
    }

    pub(super) fn fractions(&self, weights: [u32; 3]) -> [f64; 3] {
        weights.map(|w| f64::from(w) / f64::from(self.n))
    }

    /// Returns the point of the surface at a place.
    pub(super) fn point(&self, weights: [u32; 3]) -> DVec3 {
        let w = self.fractions(weights);
        let normal = sum(&self.normals, w).normalize_or_zero();
        let place = self.places[0] * w[0] + self.places[1] * w[1] + self.places[2] * w[2];
        let height = self.relief.heights.at(place) - self.relief.midlevel;
        sum(&self.positions, w) + normal * (height * self.depth(w) + self.relief.raise)
    }

    fn depth(&self, w: [f64; 3]) -> f64 {
        if let DepthRange::Uniform(depth) = self.depth_range {
            return depth;
        }
        f64::from(self.relief.depth.at(&Vertex::interpolate(self.corners, w.map(|w| w as f32))))
    }

    /// Returns axes in which the relief stands upright, as rows.
    pub(super) fn axes(&self) -> DMat3 {
        let [a, b, c] = self.positions;
        let mean: DVec3 = self.normals.iter().sum();
        let up = mean.try_normalize().or_else(|| (b - a).cross(c - a).try_normalize()).unwrap_or(DVec3::Z);
        let along = (b - a) - up * up.dot(b - a);
        let x = along.try_normalize().unwrap_or_else(|| up.any_orthonormal_vector());
        DMat3::from_cols(x, up.cross(x), up).transpose()
    }

    /// Returns the point that the local axes start from.
    pub(super) fn centre(&self) -> DVec3 {
        self.positions[0]
    }

    /// Returns what boxes need to know of a place.
    pub(super) fn corner(&self, axes: &DMat3, weights: [u32; 3]) -> Corner {
        let w = self.fractions(weights);
        let [a, b, c] = self.normals;
        let normal = if a == b && b == c { a } else { sum(&self.normals, w) };
        Corner {
            weights,
            point: *axes * (sum(&self.positions, w) - self.centre()),
            normal: *axes * normal.normalize_or_zero(),
            place: self.places[0] * w[0] + self.places[1] * w[1] + self.places[2] * w[2],
            depth: self.depth(w),
        }
    }

    /// Returns a box around the surface over the part of the triangle between three places, `size` of n long, in sheared
    /// axes.
    pub(super) fn around(&self, corners: &[Corner; 3], size: u32, shear: Shear) -> LocalBox {
        let [a, b, c] = corners;
        let (min, max) = (a.place.min(b.place).min(c.place), a.place.max(b.place).max(c.place));
        let [low, high] = self.relief.heights.range(min, max).map(|height| height - self.relief.midlevel);
        let [least, most] = self.depth_range.bounds();
        // Between the corners the depth is no farther from theirs than the whole triangle's share.
        let slack = (most - least) * f64::from(size) / f64::from(self.n);
        let shallow = (a.depth.min(b.depth).min(c.depth) - slack).max(least);
        let deep = (a.depth.max(b.depth).max(c.depth) + slack).min(most);
        let lowest = low * if low < 0.0 { deep } else { shallow };
        let highest = high * if high > 0.0 { deep } else { shallow };
        let offsets = [lowest + self.relief.raise, highest + self.relief.raise];
        let extent = self.positions.iter().map(|p| p.abs().max_element()).fold(deep, f64::max);
        let normals = [a.normal, b.normal, c.normal];
        LocalBox::around([a.point, b.point, c.point], normals, offsets, shear, 1e-13 * extent)
    }
}

fn sum(values: &[DVec3; 3], w: [f64; 3]) -> DVec3 {
    values[0] * w[0] + values[1] * w[1] + values[2] * w[2]
}

/// Returns bounds of a relief's depth over a triangle.
pub(super) fn depth_range(corners: [&Vertex; 3], depth: &ReliefDepth) -> [f32; 2] {
    let mut range = [f32::INFINITY, f32::NEG_INFINITY];
    for i in 0..=DEPTH_SAMPLES {
        for j in 0..=DEPTH_SAMPLES - i {
            let weights = [i, j, DEPTH_SAMPLES - i - j].map(|w| w as f32 / DEPTH_SAMPLES as f32);
            let at = depth.at(&Vertex::interpolate(corners, weights));
            range = [range[0].min(at), range[1].max(at)];
        }
    }
    let [least, most] = range;
    // Between the samples.
    let slack = 0.1 * (most - least);
    [(least - slack).max(0.0), most + slack]
}
