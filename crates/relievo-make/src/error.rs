//! Errors of making a material.

use relievo_map::GridError;
use thiserror::Error;

use crate::builtin::names::names;
use crate::recipe::error::RecipeError;

/// The largest material that can be made, in texels per side. Every texel takes 40 bytes of memory in
/// all, so the largest takes 10 GiB.
pub const MAX_SIZE: u32 = 1 << 14;

/// Error of a material that could not be made.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum MakeError {
    /// No material has this name.
    #[error("no generated material is called \"{name}\"{}. There are: {}", hint(*nearest), names().join(", "))]
    UnknownName {
        /// The name that was asked for.
        name: String,
        /// The known name that looks most like it, if one does.
        nearest: Option<&'static str>,
    },
    /// The size is 0 or over [`MAX_SIZE`].
    #[error("a generated material of {size}×{size} texels cannot be made: the size must be 1 to {MAX_SIZE}")]
    Size {
        /// Texels per side.
        size: u32,
    },
    /// A recipe is wrong.
    #[error(transparent)]
    Recipe(#[from] RecipeError),
    /// The maps do not fit the limits of a grid.
    #[error(transparent)]
    Grid(#[from] GridError),
}

fn hint(nearest: Option<&str>) -> String {
    nearest.map(|name| format!(" (did you mean \"{name}\"?)")).unwrap_or_default()
}
