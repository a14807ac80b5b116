//! Metrics of pictures and hits: FLIP, PSNR, percentiles, and hit errors against the oracle.

mod flip;
mod hit_error;
mod judged_pixels;
mod percentiles;
mod pixel_hits;
mod psnr;
mod ray_hits;
mod scene_charts;
mod size_mismatch;

pub use flip::{DEFAULT_PIXELS_PER_DEGREE, Flip, FlipError, flip, pixels_per_degree};
pub(crate) use hit_error::HIT_ERROR_WHITE;
pub(crate) use judged_pixels::JudgedPixels;
pub use percentiles::Percentiles;
pub use pixel_hits::PixelHitErrors;
pub(crate) use pixel_hits::{PixelHits, TruePixels};
pub use psnr::{PixelDifference, pixel_difference};
pub use ray_hits::{HitEvaluator, RayHitErrors};
pub use size_mismatch::SizeMismatch;
