//! Recipes: materials as graphs of steps, in TOML.
//!
//! A recipe names steps; each has an operation (`op`), parameters, and inputs that are the names of other steps. What the
//! operations are, and their keys, stands in `RECIPES.md`. All lengths are in uv (1 is one repeat), so that a larger map
//! shows the same design with more detail.

mod evaluate;
mod operation;
pub(crate) mod params;
mod read;
pub(crate) mod tree;

use relievo_map::MapSet;
use thiserror::Error;

use crate::{MAX_SIZE, MakeError};
use operation::Operation;

/// Why a recipe cannot be followed: one sentence that names the file and the line.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{file}{}: {message}", if *line > 0 { format!(":{line}") } else { String::new() })]
pub struct RecipeError {
    /// The recipe's name: its path, or the name of a built-in one.
    pub file: String,
    /// The line, from 1; 0 for the file as a whole.
    pub line: usize,
    /// What is wrong, what was expected, and the nearest name.
    pub message: String,
}

impl RecipeError {
    pub(crate) fn new(file: &str, line: usize, message: String) -> Self {
        Self { file: file.to_owned(), line, message }
    }
}

/// A recipe that was read and found right: no cycles, no unknown names, every parameter in its range.
#[derive(Clone, Debug, PartialEq)]
pub struct Recipe {
    description: String,
    height_scale: f32,
    /// In an order in which each comes after its inputs; only those that the maps need.
    steps: Vec<Step>,
    height: Output,
    color: Output,
    roughness: Output,
}

/// One output of one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Output {
    step: usize,
    port: usize,
}

#[derive(Clone, Debug, PartialEq)]
struct Step {
    operation: Operation,
    inputs: Vec<Output>,
    /// Which of the operation's outputs are needed.
    wanted: Vec<bool>,
    /// Whether the (only) output is a colour.
    is_color: bool,
}

impl Recipe {
    /// The most steps that a recipe may have.
    pub const MAX_STEPS: usize = 256;
    /// The longest recipe, in bytes.
    pub const MAX_BYTES: usize = 1 << 18;

    /// Reads a recipe from its text; `name` stands for it in errors. `seed` replaces the recipe's own.
    ///
    /// # Errors
    /// If it is not TOML, a key or name is not known, a parameter is out of its range, or steps need each other in a
    /// circle. The error names the line.
    pub fn parse(name: &str, text: &str, seed: Option<u32>) -> Result<Self, RecipeError> {
        read::recipe(name, text, seed)
    }

    /// What it shows, in one line.
    #[must_use]
    pub fn description(&self) -> &str {
        &self.description
    }

    /// The full range of its heights as a fraction of one repeat.
    #[must_use]
    pub fn height_scale(&self) -> f32 {
        self.height_scale
    }

    /// The most memory that [`Recipe::make`] takes for this size, in bytes, about.
    #[must_use]
    pub fn bytes(&self, size: u32) -> u64 {
        evaluate::bytes(self, size)
    }

    /// The material, `size × size` texels: base colour (sRGB), normal (+Y up), height, roughness and ambient occlusion.
    ///
    /// It tiles, and the same recipe gives the same bytes on any number of threads. Below 512 texels it is made finer and
    /// averaged.
    ///
    /// # Errors
    /// If `size` is not 1 to [`MAX_SIZE`].
    pub fn make(&self, size: u32) -> Result<MapSet, MakeError> {
        if size == 0 || size > MAX_SIZE {
            return Err(MakeError::Size { size });
        }
        evaluate::make(self, size)
    }
}
