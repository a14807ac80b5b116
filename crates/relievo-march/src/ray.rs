/// A ray into the relief (or, for shadows, out of it), in texture space.
///
/// Follows the tutorials' tangent space: with V the unit vector from the surface to the eye (or L to the light) and s the
/// full depth as a fraction of one repeat, `uv_delta = −s·V.xy` and `cos = V.z`, so that `uv(t) = uv + uv_delta/cos·t`. The two
/// are kept apart because some techniques drop or change the division.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The point where the ray crosses the lid (t = 0), in texture repeats.
    pub uv: [f32; 2],
    /// The uv travelled over the full depth, before the division by `cos`.
    pub uv_delta: [f32; 2],
    /// Height gained along V, in parts of its length: V.z, the cosine between the ray and the normal; in (0, 1] for a ray
    /// that enters from outside, above 1 only where an interpolated normal leans with it.
    pub cos: f32,
}

impl Ray {
    /// Builds the ray through `uv` seen along the tangent-space unit vector `view` (surface → eye). `scale` is the full depth
    /// as a fraction of one repeat along u and along the picture's *up* direction: the second is negative where v runs down,
    /// as in glTF. For a surface given by vectors see [`Ray::from_surface`].
    #[must_use]
    pub fn from_view(uv: [f32; 2], view: [f32; 3], scale: [f32; 2]) -> Self {
        Self { uv, uv_delta: [-view[0] * scale[0], -view[1] * scale[1]], cos: view[2] }
    }

    /// Returns the uv travelled from the lid to the full depth.
    #[inline]
    #[must_use]
    pub fn slope(&self) -> [f32; 2] {
        [self.uv_delta[0] / self.cos, self.uv_delta[1] / self.cos]
    }

    /// Returns `uv(t)`.
    #[inline]
    #[must_use]
    pub fn at(&self, t: f32) -> [f32; 2] {
        let slope = self.slope();
        [self.uv[0] + slope[0] * t, self.uv[1] + slope[1] * t]
    }

    /// Returns true if every number is finite, the ray enters from outside, and no texel it can reach lies beyond the range in
    /// which f32 and i32 can address texels at all.
    pub(crate) fn is_usable(&self, size: [u32; 2]) -> bool {
        let slope = self.slope();
        self.cos > 0.0
            && (0..2).all(|k| {
                // Twice the slope: a relief that rises above its polygon is entered before it.
                let reach = (self.uv[k].abs() + 2.0 * slope[k].abs()) * size[k] as f32;
                // Also false for NaN.
                reach < (1 << 30) as f32
            })
    }
}

/// The result of a march and its cost: the same for every technique.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Record {
    /// The displaced texture coordinates, in texture repeats. The ray's own uv on a miss.
    pub uv: [f32; 2],
    /// The depth below the lid: 0 = on it, 1 = on the floor.
    pub depth: f32,
    /// True if the surface was met inside the bounds.
    pub hit: bool,
    /// Height look-ups: filtered samples, or for [`crate::Technique::Exact`] nodes of the max pyramid and gathers of the four
    /// corners of a cell.
    pub fetches: u32,
    /// Iterations of the technique's loops.
    pub iterations: u32,
}

impl Record {
    /// Returns a miss at the given cost.
    pub(crate) fn miss(ray: &Ray, fetches: u32, iterations: u32) -> Self {
        Self { uv: ray.uv, depth: 0.0, hit: false, fetches, iterations }
    }
}
