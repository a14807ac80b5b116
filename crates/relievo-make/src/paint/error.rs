//! Errors of reading strokes.

use thiserror::Error;

use crate::recipe::error::RecipeError;

/// Error of a stroke file or a drawing.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum PaintError {
    /// A stroke file is wrong; names the line.
    #[error(transparent)]
    File(#[from] RecipeError),
    /// An SVG drawing is wrong.
    #[error("{file}: {message}")]
    Svg {
        /// The drawing's name.
        file: String,
        /// The fault and its remedy.
        message: String,
    },
}
