//! How long frames took.

/// The least, the middle and the most of several times, milliseconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameTimes {
    /// How many frames.
    pub frames: usize,
    /// The shortest.
    pub min: f64,
    /// As many are longer as are shorter.
    pub median: f64,
    /// The longest.
    pub max: f64,
}

impl FrameTimes {
    /// Of these times; `None` if there are none.
    #[must_use]
    pub fn of(times: &[f64]) -> Option<Self> {
        let mut sorted = times.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        let (&min, &max) = (sorted.first()?, sorted.last()?);
        let middle = sorted.len() / 2;
        let median = if sorted.len() % 2 == 1 { sorted[middle] } else { 0.5 * (sorted[middle - 1] + sorted[middle]) };
        Some(Self { frames: sorted.len(), min, median, max })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_lies_in_the_middle() {
        let odd = FrameTimes::of(&[3.0, 1.0, 2.0]).unwrap();
        assert_eq!((odd.frames, odd.min, odd.median, odd.max), (3, 1.0, 2.0, 3.0));
        assert_eq!(FrameTimes::of(&[4.0, 1.0]).unwrap().median, 2.5);
        assert_eq!(FrameTimes::of(&[]), None);
    }
}
