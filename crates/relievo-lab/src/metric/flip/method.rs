/// The constants of FLIP.
#[derive(Clone, Debug)]
pub(super) struct Method {
    /// Contrast sensitivity along Y, red-green and blue-yellow: each a sum of Gaussians, by amplitude and by width in
    /// degrees squared (`a·√(π/b)·exp(−π²x²/b)`).
    pub(super) sensitivity: [&'static [(f64, f64)]; 3],
    /// Exponent on colour differences.
    pub(super) color_exponent: f32,
    /// Fraction of the largest colour difference at which the curve bends.
    pub(super) bend: f32,
    /// Result at the bend, 0 to 1; larger differences share the rest of the range.
    pub(super) bend_result: f32,
    /// Exponent on feature differences.
    pub(super) feature_exponent: f32,
    /// Width of the features that are detected, in degrees.
    pub(super) feature_width: f64,
}

impl Method {
    pub(super) const PUBLISHED: Self = Self {
        sensitivity: [&[(1.0, 0.0047)], &[(1.0, 0.0053)], &[(34.1, 0.04), (13.5, 0.025)]],
        color_exponent: 0.7,
        bend: 0.4,
        bend_result: 0.95,
        feature_exponent: 0.5,
        feature_width: 0.082,
    };
}
