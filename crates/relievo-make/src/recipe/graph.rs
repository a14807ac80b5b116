//! A recipe that was read: its steps in the order in which they are made.

use super::operation::Operation;

/// A recipe that was read and found right: no cycles, no unknown names, every parameter in its range.
#[derive(Clone, Debug, PartialEq)]
pub struct Recipe {
    pub(super) description: String,
    pub(super) height_scale: f32,
    pub(super) period: f32,
    /// In topological order: each comes after its inputs; only those that the maps need.
    pub(super) steps: Vec<RecipeStep>,
    pub(super) height: OutputRef,
    pub(super) color: OutputRef,
    pub(super) roughness: OutputRef,
}

/// One output of one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct OutputRef {
    pub(super) step: usize,
    pub(super) port: usize,
}

/// An operation with its inputs.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RecipeStep {
    pub(super) operation: Operation,
    pub(super) inputs: Vec<OutputRef>,
    /// True for each of the operation's outputs that is needed.
    pub(super) wanted: Vec<bool>,
    /// True if the (only) output is a colour.
    pub(super) is_color: bool,
}

impl Recipe {
    /// The most steps that a recipe may have.
    pub const MAX_STEPS: usize = 256;
    /// The longest recipe, in bytes.
    pub const MAX_BYTES: usize = 1 << 18;

    /// Returns the material's description, one line.
    #[must_use]
    pub fn description(&self) -> &str {
        &self.description
    }

    /// Returns the full range of the heights as a fraction of one repeat.
    #[must_use]
    pub fn height_scale(&self) -> f32 {
        self.height_scale
    }

    /// Returns the length of the recipe's loop in seconds, where nothing else is asked for.
    #[must_use]
    pub fn period(&self) -> f32 {
        self.period
    }

    /// True if the maps change in the course of the loop.
    #[must_use]
    pub fn is_animated(&self) -> bool {
        self.steps.iter().any(|step| step.operation.is_animated())
    }
}
