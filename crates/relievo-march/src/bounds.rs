/// A rectangle of uv outside of which there is no surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lower corner, in texture repeats.
    pub min: [f32; 2],
    /// Upper corner, in texture repeats.
    pub max: [f32; 2],
}

impl Bounds {
    /// One texture repeat.
    pub const TILE: Self = Self { min: [0.0; 2], max: [1.0; 2] };

    /// Returns true if `uv` lies inside or on the border.
    #[inline]
    #[must_use]
    pub fn contains(&self, uv: [f32; 2]) -> bool {
        (0..2).all(|k| uv[k] >= self.min[k] && uv[k] <= self.max[k])
    }

    /// Returns the first and the last texel along u and along v, of a map of this size: one at least.
    #[must_use]
    pub fn texels(&self, size: [u32; 2]) -> [[i32; 2]; 2] {
        [0, 1].map(|k| {
            let [first, end] = [self.min[k], self.max[k]].map(|x| (x * size[k] as f32).round() as i32);
            [first, end.saturating_sub(1).max(first)]
        })
    }
}
