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
}
