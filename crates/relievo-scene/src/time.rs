//! The clock of scenes.

use std::fmt;

/// Units of time per second: a multiple of the frame rates in use (24, 25, 30, 48, 50, 60, 90, 100, 120 and their NTSC kin), so
/// that frames and loops are whole numbers of them. The unit is the *flick* of OculusVR's library of that name (2018).
const PER_SECOND: f64 = 705_600_000.0;

/// A time of a scene, in whole units of 1/705 600 000 s: a time that is reached in two ways is the same to the last bit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SceneTime(i64);

impl SceneTime {
    /// Largest time, and the negative of the smallest, seconds: eleven days.
    pub const MAX_SECONDS: f64 = 1e6;

    /// Rounds seconds to the clock's unit; `None` if they are not finite, or beyond [`SceneTime::MAX_SECONDS`].
    #[must_use]
    pub fn from_seconds(seconds: f64) -> Option<Self> {
        (seconds.abs() <= Self::MAX_SECONDS).then(|| Self((seconds * PER_SECOND).round() as i64))
    }

    /// Returns the time in seconds.
    #[must_use]
    pub fn seconds(self) -> f64 {
        self.0 as f64 / PER_SECOND
    }

    /// Returns the time of a frame that many frames after this one, at a frame rate above 0 per second.
    #[must_use]
    pub fn after_frames(self, frames: u32, per_second: f64) -> Self {
        let most = (Self::MAX_SECONDS * PER_SECOND) as i64;
        Self(self.0.saturating_add((f64::from(frames) * PER_SECOND / per_second).round() as i64).clamp(-most, most))
    }

    /// Returns the frames from this time on that lie before `end`, at a frame rate above 0 per second.
    #[must_use]
    pub fn frames_before(self, end: Self, per_second: f64) -> u64 {
        // Half a unit: the end of a loop is not a frame of it, however the rate rounds.
        (((end.0 - self.0) as f64 - 0.5) * per_second / PER_SECOND).ceil().max(0.0) as u64
    }

    /// Returns the time within a loop of this length that begins at 0: at least 0, below the length. A loop of no length is none.
    #[must_use]
    pub fn wrapped(self, length: Self) -> Self {
        if length.0 > 0 { Self(self.0.rem_euclid(length.0)) } else { self }
    }

    /// Returns the part of a loop of this length that has passed: at least 0, below 1; 0 for a loop of no length.
    #[must_use]
    pub fn phase(self, length: Self) -> f64 {
        if length.0 > 0 { self.0.rem_euclid(length.0) as f64 / length.0 as f64 } else { 0.0 }
    }

    /// Returns the time since an earlier one.
    #[must_use]
    pub fn since(self, earlier: Self) -> Self {
        Self(self.0 - earlier.0)
    }
}

/// Seconds.
impl fmt::Display for SceneTime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} s", self.seconds())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(seconds: f64) -> SceneTime {
        SceneTime::from_seconds(seconds).unwrap()
    }

    #[test]
    fn the_frame_after_a_loop_is_its_first_one_at_every_rate() {
        for rate in [1.0, 12.0, 23.976, 24.0, 25.0, 29.97, 30.0, 50.0, 59.94, 60.0, 144.0] {
            for (start, length) in [(0.0, 4.0), (0.1, 0.2), (-3.0, 1.0), (12_345.6, 7.0)] {
                let (start, length) = (at(start), at(length));
                let count = start.frames_before(SceneTime(start.0 + length.0), rate);
                let exact = length.seconds() * rate;
                assert_eq!(count, (exact - 1e-6).ceil() as u64, "{rate} {length}");
                if (exact - exact.round()).abs() < 1e-9 {
                    let after = start.after_frames(count as u32, rate);
                    assert_eq!(after.wrapped(length), start.wrapped(length), "{rate} {length}");
                    assert_eq!(after.phase(length).to_bits(), start.phase(length).to_bits());
                }
            }
        }
    }

    #[test]
    fn times_are_finite_and_bounded() {
        for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY, 1.1e6, -1e300] {
            assert_eq!(SceneTime::from_seconds(bad), None);
        }
        assert_eq!(at(1.5).seconds(), 1.5);
        assert_eq!(at(-0.5).wrapped(at(2.0)), at(1.5));
        assert_eq!((at(3.0).phase(at(2.0)), at(3.0).phase(at(0.0)), at(3.0).wrapped(at(0.0))), (0.5, 0.0, at(3.0)));
        assert_eq!(at(9e5).after_frames(u32::MAX, 1e-9), at(1e6));
        assert_eq!((at(0.0).frames_before(at(0.0), 30.0), at(1.0).frames_before(at(0.0), 30.0)), (0, 0));
    }
}
