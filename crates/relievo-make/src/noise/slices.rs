//! Noise that changes: slices of random numbers over a loop, which closes exactly.

use super::random::hash3;
use crate::curve::fade;

/// Salt of the seeds of slices.
const SLICE: u32 = 0x0071_3e5d;

/// The two slices of random numbers around a moment of a loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Slices {
    /// Seeds of the slice before and of the one after.
    pub(crate) seeds: [u32; 2],
    /// Time since the slice before, in slices: 0 to below 1.
    pub(crate) offset: f32,
    /// Weight of the slice after.
    pub(crate) weight: f32,
}

impl Slices {
    /// Returns the slices around a phase of the loop, 0 to below 1; `None` for noise that stands still, with no slices. The
    /// first slice has the seed itself, so that changing noise begins with what stands still.
    pub(crate) fn around(seed: u32, count: u32, phase: f64) -> Option<Self> {
        if count == 0 {
            return None;
        }
        let position = (phase - phase.floor()) * f64::from(count);
        let slice = (position as u32).min(count - 1);
        let seed_of = |slice: u32| if slice == 0 { seed } else { hash3(seed, slice, SLICE)[0] };
        let offset = (position - f64::from(slice)) as f32;
        let after = if slice + 1 == count { 0 } else { slice + 1 };
        Some(Self { seeds: [seed_of(slice), seed_of(after)], offset, weight: fade(offset) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slices_follow_each_other_and_close() {
        let at = |phase| Slices::around(7, 3, phase).unwrap();
        assert_eq!(Slices::around(7, 0, 0.3), None);
        assert_eq!((at(0.0).seeds[0], at(0.0).offset, at(0.0).weight), (7, 0.0, 0.0));
        assert_eq!(at(0.1).seeds[1], at(0.4).seeds[0]);
        assert_eq!(at(0.9).seeds[1], 7);
        assert_eq!(at(0.0), at(1.0));
        assert!(at(0.999_999_999_999_9).weight <= 1.0);
    }
}
