//! Finite differences on texels: kernels and borders.

/// A finite-difference kernel for slopes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
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

    /// Weight of each of the two rows beside; all three sum to 1.
    pub(super) fn side_weight(self) -> f64 {
        match self {
            Self::Central => 0.0,
            Self::Sobel => 1.0 / 4.0,
            Self::Scharr => 3.0 / 16.0,
        }
    }

    /// Response of the average over three rows to a wave of `w` radians per texel.
    pub(super) fn row_response(self, w: f64) -> f64 {
        1.0 - 2.0 * self.side_weight() * (1.0 - w.cos())
    }
}

/// The values beyond the border of a map that is measured or converted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Border {
    /// The map tiles.
    #[default]
    Wrap,
    /// None: slopes are one-sided at the border, so that a ramp is a ramp up to its ends.
    Open,
}
