//! Errors of making heights of a photograph.

use relievo_map::GridError;
use thiserror::Error;

/// Error of a photograph of which no heights could be made.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum PhotoError {
    /// The mask has another size.
    #[error(
        "the mask has {}×{} texels and the photograph {}×{}; give a mask of the same size",
        mask[0], mask[1], photo[0], photo[1]
    )]
    MaskSize {
        /// Width and height.
        mask: [u32; 2],
        /// Width and height.
        photo: [u32; 2],
    },
    /// The mask is 0 everywhere.
    #[error("the mask is black everywhere, so that nothing of the photograph would be used; paint white what counts")]
    EmptyMask,
    /// A map cannot have this size.
    #[error(transparent)]
    Grid(#[from] GridError),
}
