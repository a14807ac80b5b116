//! The definition of a hit error, for pixels and for rays alike.
//!
//! The error of a hit is its distance in uv from the oracle's first intersection, in texels of the map. A hit is wrong if
//! that is more than [`WRONG_TEXELS`], or if only one of technique and oracle hits. Percentiles are over the hits alone.
//!
//! The two users differ in what they count: [`pixel_hits`](super::pixel_hits) judges every pixel in which technique or
//! oracle shows relief, with f32 uv from the renderer; [`ray_hits`](super::ray_hits) judges every ray that the oracle hits,
//! in f64, and forgives rays that touch a crest within rounding (`grazing`).

use num_traits::Float;

use super::percentiles::Percentiles;

/// The largest hit error that is not wrong, in texels.
pub(super) const WRONG_TEXELS: f64 = 1.0;

/// The hit error that maps of hit errors draw white, in texels.
pub(crate) const HIT_ERROR_WHITE: f32 = 8.0;

/// Offset of a hit from another in uv, in texels of a map of this size.
pub(super) fn texel_offset<T: Float>(hit: [T; 2], truth: [T; 2], size: [T; 2]) -> [T; 2] {
    [0, 1].map(|k| (hit[k] - truth[k]) * size[k])
}

/// Length of an offset.
pub(super) fn length<T: Float>([u, v]: [T; 2]) -> T {
    u.hypot(v)
}

/// Figures over many hit errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HitErrorSummary {
    /// Fraction of all that is wrong.
    pub(super) wrong: f64,
    /// Fraction of all where only one of technique and oracle hits.
    pub(super) only_one_hits: f64,
    /// Errors of the hits, in texels.
    pub(super) texels: Percentiles,
}

impl HitErrorSummary {
    /// Sums up hit errors in texels; `None` where only one of technique and oracle hits.
    pub(super) fn new(errors: impl Iterator<Item = Option<f64>>) -> Self {
        let mut hits = Vec::new();
        let (mut all, mut wrong, mut only_one_hits) = (0usize, 0usize, 0usize);
        for error in errors {
            all += 1;
            match error {
                Some(texels) => {
                    wrong += usize::from(!(texels <= WRONG_TEXELS));
                    hits.push(texels as f32);
                }
                None => {
                    wrong += 1;
                    only_one_hits += 1;
                }
            }
        }
        let fraction = |count: usize| count as f64 / all.max(1) as f64;
        Self { wrong: fraction(wrong), only_one_hits: fraction(only_one_hits), texels: Percentiles::of(hits) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_texel_is_not_wrong_and_a_missing_hit_is() {
        let summary = HitErrorSummary::new([Some(0.0), Some(1.0), Some(1.5), None].into_iter());
        assert_eq!((summary.wrong, summary.only_one_hits), (0.5, 0.25));
        assert_eq!((summary.texels.max, summary.texels.p50), (1.5, 1.0));
        assert_eq!(HitErrorSummary::new(std::iter::empty()).wrong, 0.0);
        assert_eq!(length(texel_offset([0.5f32, 0.25], [0.25, 0.25], [64.0, 32.0])), 16.0);
    }
}
