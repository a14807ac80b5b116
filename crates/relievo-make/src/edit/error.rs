//! Errors of editing.

use relievo_map::GridError;
use thiserror::Error;

/// The largest radius of `median`.
pub const MAX_MEDIAN: u32 = 16;

/// Error of an edit.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum EditError {
    /// Two maps that are combined have different sizes.
    #[error(
        "maps of {}×{} and {}×{} texels cannot be put together; resize one of them first",
        a[0], a[1], b[0], b[1]
    )]
    Size {
        /// Width and height of the first.
        a: [u32; 2],
        /// Width and height of the second.
        b: [u32; 2],
    },
    /// The points of a curve do not rise.
    #[error("a curve needs at least two points whose first numbers rise")]
    Curve,
    /// The radius of a median is too large.
    #[error("the radius of a median is at most {max} texels, not {radius}", max = MAX_MEDIAN)]
    Median {
        /// The requested radius, in texels.
        radius: u32,
    },
    /// Normals cannot be edited like numbers.
    #[error("normals can be rotated and flipped, but not edited; make heights of them first")]
    Normals,
    /// A map cannot have this size.
    #[error(transparent)]
    Grid(#[from] GridError),
}
