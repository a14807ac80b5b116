use crate::error::LabError;

/// The unit of an error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorUnit {
    /// 99th percentile of the distance in uv from the oracle's hits, in texels.
    #[default]
    Texels,
    /// The same in pixels of one texel: the part along the view is shortened by the angle's cosine.
    Pixels,
    /// Mean FLIP of a picture against displaced geometry, 0 to 1.
    Flip,
}

impl ErrorUnit {
    /// All units with their names.
    pub const ALL: [(&'static str, Self); 3] =
        [("texels", Self::Texels), ("pixels", Self::Pixels), ("flip", Self::Flip)];

    /// The unit's symbol, after a number.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Texels => "texels",
            Self::Pixels => "pixels",
            Self::Flip => "FLIP",
        }
    }
}

/// The cost that is minimised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum TechniqueCost {
    /// Measured time of a ray: specific to the machine, and not reproducible.
    #[default]
    Time,
    /// Mean fetches of a ray, of all kinds together: the same on every machine.
    Fetches,
}

impl TechniqueCost {
    /// All costs with their names.
    pub const ALL: [(&'static str, Self); 2] = [("time", Self::Time), ("fetches", Self::Fetches)];
}

/// Options of tuning.
#[derive(Clone, Debug, PartialEq)]
pub struct TuneOptions {
    /// Largest allowed error, at every angle.
    pub max_error: f64,
    /// Unit of the error.
    pub unit: ErrorUnit,
    /// Largest angle from the normal, in degrees, 0 to 89.9 (85 for FLIP).
    pub angle_max: f32,
    /// The full depth, in texels along u.
    pub depth: f32,
    /// The cost that is minimised.
    pub cost: TechniqueCost,
    /// Rays per angle.
    pub rays: u32,
    /// Rounds in which each march is timed; the best counts.
    pub rounds: u32,
}

impl Default for TuneOptions {
    fn default() -> Self {
        Self {
            max_error: 1.0,
            unit: ErrorUnit::default(),
            angle_max: 80.0,
            depth: 25.0,
            cost: TechniqueCost::default(),
            rays: 4096,
            rounds: 5,
        }
    }
}

impl TuneOptions {
    /// Checks the ranges.
    pub(super) fn check(&self) -> Result<(), LabError> {
        let refused = |text: String| Err(LabError::Options(text));
        let most = if self.unit == ErrorUnit::Flip { 85.0 } else { 89.9 };
        if !(0.0..=most).contains(&self.angle_max) {
            return refused(format!("the largest angle must be 0 to {most}°, not {}", self.angle_max));
        }
        if !(self.max_error >= 0.0) {
            return refused(format!("the largest error must be a number from 0 on, not {}", self.max_error));
        }
        if !(0.0..=4096.0).contains(&self.depth) {
            return refused(format!("a depth of {} texels cannot be tuned for: it must be 0 to 4096", self.depth));
        }
        Ok(())
    }
}
