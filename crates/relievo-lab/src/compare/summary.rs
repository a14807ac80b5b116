use serde::Serialize;

use super::comparison::Comparison;
use crate::metric::{Percentiles, PixelHitErrors};

impl Comparison {
    /// Returns the figures without the pictures, for JSON.
    #[must_use]
    pub fn summary(&self) -> Summary {
        Summary {
            truth: TruthSummary {
                grids: self.truth_grids.clone(),
                // JSON has no infinity: a relief that no object wears.
                per_texel: self.truth_per_texel.iter().map(|n| n.is_finite().then_some(*n)).collect(),
                notes: self.truth_notes.clone(),
                triangles: self.truth_triangles,
                frame_ms: self.truth_frame_ms,
                build_ms: self.truth_build_ms,
            },
            width: self.truth.width(),
            height: self.truth.height(),
            techniques: self
                .entries
                .iter()
                .map(|entry| EntrySummary {
                    technique: entry.technique.to_string(),
                    flip: entry.flip.mean,
                    // JSON has no infinity.
                    psnr_db: entry.psnr.is_finite().then_some(entry.psnr),
                    hit_error: entry.hits,
                    fetches: entry.fetches,
                    iterations: entry.iterations,
                    frame_ms: entry.frame_ms,
                    build_ms: entry.build_ms,
                    triangles: entry.triangles,
                })
                .collect(),
        }
    }
}

/// The figures of a [`Comparison`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// Width of the pictures, pixels.
    pub width: u32,
    /// Height of the pictures, pixels.
    pub height: u32,
    /// The truth that all are judged by.
    pub truth: TruthSummary,
    /// The techniques, in the order of the options.
    pub techniques: Vec<EntrySummary>,
}

/// The cost of the displaced truth.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TruthSummary {
    /// Vertices per side, one per material with a relief.
    pub grids: Vec<u32>,
    /// Vertices along a texel where they stand farthest apart, one per material with a relief; `null` where no object wears it.
    pub per_texel: Vec<Option<f64>>,
    /// Sentences on where the truth is too coarse to judge by; empty where it is not.
    pub notes: Vec<String>,
    /// Triangles in the scene.
    pub triangles: usize,
    /// Time to draw, milliseconds.
    pub frame_ms: f64,
    /// Time to build, milliseconds.
    pub build_ms: f64,
}

/// The figures of one [`ComparisonEntry`](crate::ComparisonEntry).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EntrySummary {
    /// The technique, as on the command line.
    pub technique: String,
    /// Mean FLIP, 0 to 1.
    pub flip: f64,
    /// PSNR in dB; `null` where the pictures are equal.
    pub psnr_db: Option<f64>,
    /// Hit errors against the true surface.
    pub hit_error: PixelHitErrors,
    /// Height look-ups over the relief's pixels.
    pub fetches: Percentiles,
    /// Loop iterations over the relief's pixels.
    pub iterations: Percentiles,
    /// Time to draw, milliseconds.
    pub frame_ms: f64,
    /// Time to build, milliseconds.
    pub build_ms: f64,
    /// Triangles in the scene.
    pub triangles: usize,
}
