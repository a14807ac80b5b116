//! Judges techniques against the truth: FLIP, PSNR, hit errors, comparison sheets.

mod flip;
mod psnr;
mod size;

pub use flip::{DEFAULT_PIXELS_PER_DEGREE, Flip, FlipError, flip, pixels_per_degree};
pub use psnr::{PixelDifference, pixel_difference};
pub use size::SizeMismatch;
