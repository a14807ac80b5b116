//! Frame times.

/// Time of a frame, milliseconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FrameTime {
    /// By the device's own clock: its work alone.
    Gpu(f64),
    /// From the first command until the device was done.
    Wall(f64),
}

impl FrameTime {
    /// The number.
    #[must_use]
    pub fn milliseconds(self) -> f64 {
        match self {
            Self::Gpu(ms) | Self::Wall(ms) => ms,
        }
    }

    /// Name of the clock: "GPU" or "wall".
    #[must_use]
    pub fn clock(self) -> &'static str {
        match self {
            Self::Gpu(_) => "GPU",
            Self::Wall(_) => "wall",
        }
    }
}

/// Minimum, median and maximum of several times, milliseconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameTimes {
    /// Number of frames.
    pub frames: usize,
    /// The clock they were taken by, as [`FrameTime::clock`].
    pub clock: &'static str,
    /// The shortest.
    pub min: f64,
    /// The median.
    pub median: f64,
    /// The longest.
    pub max: f64,
}

impl FrameTimes {
    /// Computes the statistics of these times; `None` if there are none.
    #[must_use]
    pub fn of(times: &[FrameTime]) -> Option<Self> {
        // A device whose clock fails now and then is timed by ours.
        let clock = times.iter().find(|time| matches!(time, FrameTime::Wall(_))).or(times.first())?.clock();
        let mut sorted: Vec<f64> =
            times.iter().filter(|time| time.clock() == clock).map(|time| time.milliseconds()).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let (&min, &max) = (sorted.first()?, sorted.last()?);
        let middle = sorted.len() / 2;
        let median = if sorted.len() % 2 == 1 { sorted[middle] } else { 0.5 * (sorted[middle - 1] + sorted[middle]) };
        Some(Self { frames: sorted.len(), clock, min, median, max })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_lies_in_the_middle() {
        let odd = FrameTimes::of(&[3.0, 1.0, 2.0].map(FrameTime::Gpu)).unwrap();
        assert_eq!((odd.frames, odd.min, odd.median, odd.max), (3, 1.0, 2.0, 3.0));
        assert_eq!(FrameTimes::of(&[4.0, 1.0].map(FrameTime::Wall)).unwrap().median, 2.5);
        assert_eq!(FrameTimes::of(&[]), None);
    }

    #[test]
    fn clocks_are_not_mixed() {
        let times = FrameTimes::of(&[FrameTime::Gpu(1.0), FrameTime::Wall(5.0), FrameTime::Gpu(2.0)]).unwrap();
        assert_eq!((times.clock, times.frames, times.median), ("wall", 1, 5.0));
    }
}
