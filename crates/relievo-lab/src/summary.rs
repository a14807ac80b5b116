use serde::Serialize;

use crate::{Comparison, HitErrors, Percentiles};

impl Comparison {
    /// The figures without the pictures, for JSON.
    #[must_use]
    pub fn summary(&self) -> Summary {
        Summary {
            truth: TruthSummary {
                grids: self.truth_grids.clone(),
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
                    technique: entry.contender.to_string(),
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
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// What all are judged by.
    pub truth: TruthSummary,
    /// In the order asked for.
    pub techniques: Vec<EntrySummary>,
}

/// What all are judged by.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TruthSummary {
    /// Vertices per side, one per material with a relief.
    pub grids: Vec<u32>,
    /// In the scene.
    pub triangles: usize,
    /// Milliseconds.
    pub frame_ms: f64,
    /// Milliseconds.
    pub build_ms: f64,
}

/// The figures of one [`Entry`](crate::Entry).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EntrySummary {
    /// As on the command line.
    pub technique: String,
    /// Mean FLIP, 0 to 1.
    pub flip: f64,
    /// dB; `null` where the pictures are equal.
    pub psnr_db: Option<f64>,
    /// Against the oracle.
    pub hit_error: HitErrors,
    /// Height look-ups over the relief's pixels.
    pub fetches: Percentiles,
    /// Loop turns over the relief's pixels.
    pub iterations: Percentiles,
    /// Milliseconds.
    pub frame_ms: f64,
    /// Milliseconds.
    pub build_ms: f64,
    /// In the scene.
    pub triangles: usize,
}
