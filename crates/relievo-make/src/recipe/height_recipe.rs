use relievo_map::{Grid, HeightMap};

use super::evaluate::{check_size, evaluate_steps, heights, samples_per_side};
use super::graph::{OutputRef, Recipe, RecipeStep};
use super::program::HeightProgram;
use crate::error::MakeError;

/// The heights of a recipe alone, with the steps that they need: for heights that change in the course of a loop.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightRecipe {
    steps: Vec<RecipeStep>,
    height: OutputRef,
}

impl HeightRecipe {
    /// Takes the heights of a recipe.
    #[must_use]
    pub fn of(recipe: &Recipe) -> Self {
        let mut wanted: Vec<Vec<bool>> = recipe.steps.iter().map(|step| vec![false; step.wanted.len()]).collect();
        wanted[recipe.height.step][recipe.height.port] = true;
        for k in (0..recipe.steps.len()).rev() {
            if wanted[k].contains(&true) {
                recipe.steps[k].inputs.iter().for_each(|input| wanted[input.step][input.port] = true);
            }
        }
        // Steps keep their order: each comes after its inputs.
        let (mut places, mut steps) = (Vec::new(), Vec::new());
        for (step, wanted) in recipe.steps.iter().zip(wanted) {
            places.push(steps.len());
            if wanted.contains(&true) {
                let inputs = step.inputs.iter().map(|input| OutputRef { step: places[input.step], ..*input }).collect();
                steps.push(RecipeStep { inputs, wanted, ..step.clone() });
            }
        }
        let height = OutputRef { step: places[recipe.height.step], ..recipe.height };
        Self { steps, height }
    }

    /// True if the heights change in the course of the loop.
    #[must_use]
    pub fn is_animated(&self) -> bool {
        self.steps.iter().any(|step| step.operation.is_animated())
    }

    /// Makes the heights at a phase of the loop, `size × size` texels in 0..1: those of [`Recipe::make_at`].
    ///
    /// # Errors
    /// If `size` is not 1 to [`crate::MAX_SIZE`].
    pub fn heights(&self, size: u32, phase: f64) -> Result<HeightMap, MakeError> {
        check_size(size)?;
        let fine = samples_per_side(size) as usize;
        let n = size as usize * fine;
        let values = evaluate_steps(&self.steps, &[self.height], n, phase);
        Ok(HeightMap::new(Grid::new(size, size, heights(&values[0], n, fine))?))
    }

    /// Returns the heights as a program for a shader, if every step computes a texel from nothing but the same texel of other
    /// steps: `noise` and `formula` without colours.
    #[must_use]
    pub fn program(&self, size: u32) -> Option<HeightProgram> {
        check_size(size).ok()?;
        HeightProgram::new(&self.steps, self.height.step, size)
    }
}
