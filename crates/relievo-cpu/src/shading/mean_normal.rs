use glam::Vec3;

/// The mean of the normals that a pixel covers.
#[derive(Clone, Copy)]
pub(crate) struct MeanNormal {
    /// Direction of any length.
    pub(crate) direction: Vec3,
    /// Length of the mean of unit normals, in (0, 1]: 1 where all are equal, less the more they scatter (Toksvig 2005).
    pub(crate) length: f32,
}

impl MeanNormal {
    /// Returns the mean of samples that are means themselves: directions of any length, and lengths.
    pub(crate) fn of(samples: impl ExactSizeIterator<Item = (Vec3, f32)>) -> Self {
        let count = samples.len();
        let mut first = None;
        let mut sum = Vec3::ZERO;
        for (direction, length) in samples {
            first.get_or_insert((direction, length));
            sum += direction.normalize_or_zero() * length;
        }
        match first {
            // One sample is left as it is: where nothing is averaged the picture is the same to the last bit.
            Some((direction, length)) if count == 1 => Self { direction, length },
            _ => Self { direction: sum, length: (sum.length() / count as f32).min(1.0) },
        }
    }

    /// Returns the length of the mean where slopes have this mean variance along an axis, for unit normals that lean by
    /// small angles: the inverse of [`MeanNormal::variance`].
    pub(crate) fn length_of(variance: f32) -> f32 {
        1.0 / (1.0 + variance)
    }

    /// Returns the variance of the slopes along an axis that goes with a mean's length (Toksvig 2005).
    pub(crate) fn variance(length: f32) -> f32 {
        // Normals all around, or none: as rough as can be.
        (1.0 - length) / length.max(1e-3)
    }
}
