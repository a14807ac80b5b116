use std::sync::Arc;

use relievo_make::{HeightLayers, HeightRecipe, MakeError};
use relievo_map::HeightMap;

/// Heights that change in the course of time, at a moment: for renderers that make them on a device.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ChangingHeights {
    /// A recipe in its loop.
    Recipe {
        /// The recipe.
        recipe: Arc<HeightRecipe>,
        /// Texels per side, 1 to [`relievo_make::MAX_SIZE`].
        size: u32,
        /// Part of the loop that has passed, 0 to below 1.
        phase: f64,
    },
    /// Height maps that move over each other.
    Layers {
        /// The maps.
        layers: Arc<HeightLayers>,
        /// Time in seconds.
        seconds: f64,
    },
}

impl ChangingHeights {
    /// Makes the heights of the moment.
    ///
    /// # Errors
    /// If the size is impossible.
    pub fn heights(&self) -> Result<HeightMap, MakeError> {
        match self {
            Self::Recipe { recipe, size, phase } => recipe.heights(*size, *phase),
            Self::Layers { layers, seconds } => Ok(layers.heights(*seconds)?),
        }
    }

    /// True if both are the same heights, at whatever moment.
    #[must_use]
    pub fn is_same_source(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Recipe { recipe: a, size, .. }, Self::Recipe { recipe: b, size: other, .. }) => {
                Arc::ptr_eq(a, b) && size == other
            }
            (Self::Layers { layers: a, .. }, Self::Layers { layers: b, .. }) => Arc::ptr_eq(a, b),
            _ => false,
        }
    }
}
