//! Recipes: materials as graphs of steps, in TOML.
//!
//! A recipe names steps; each has an operation (`op`), parameters, and inputs that are the names of other steps.
//! `RECIPES.md` lists the operations and their keys. All lengths are in uv (1 is one repeat), so that a larger map shows
//! the same design with more detail.

mod erosion;
pub(crate) mod error;
mod evaluate;
mod evaluate_step;
mod formula;
mod graph;
mod height_recipe;
mod operation;
mod order;
pub(crate) mod params;
mod program;
mod read;
mod read_operation;
pub(crate) mod tree;
mod value;

pub use error::RecipeError;
pub use graph::Recipe;
pub use height_recipe::HeightRecipe;
pub use program::{HeightProgram, OctaveEntry};
