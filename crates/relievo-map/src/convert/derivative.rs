//! Finite differences on texels: kernels and borders.

/// How a slope is measured on texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DerivativeKernel {
    /// Half the difference of the two neighbours.
    #[default]
    Central,
    /// The same, averaged over three rows with weights 1 2 1 (Sobel and Feldman 1968): smoother.
    Sobel,
    /// The same with weights 3 10 3 (Scharr 2000): the direction of slopes is nearly right at any angle.
    Scharr,
}

impl DerivativeKernel {
    /// All kernels and their names.
    pub const ALL: [(&'static str, Self); 3] =
        [("central", Self::Central), ("sobel", Self::Sobel), ("scharr", Self::Scharr)];

    /// The weight of the rows beside, of 1.
    pub(super) fn side(self) -> f64 {
        match self {
            Self::Central => 0.0,
            Self::Sobel => 1.0 / 4.0,
            Self::Scharr => 3.0 / 16.0,
        }
    }

    /// What the average over three rows leaves of a wave of `w` radians per texel.
    pub(super) fn smoothing(self, w: f64) -> f64 {
        1.0 - 2.0 * self.side() * (1.0 - w.cos())
    }
}

/// What lies beyond the border of a map that is measured or converted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Border {
    /// The map tiles.
    #[default]
    Wrap,
    /// Nothing: slopes are one-sided at the border, so that a ramp is a ramp up to its ends.
    Open,
}
