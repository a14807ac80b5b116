//! Evaluation of a recipe: step by step, each on all cores, each result freed after its last use.

use rayon::prelude::*;
use relievo_map::{MapSet, linear_to_srgb, srgb_to_linear};

use super::evaluate_step::{StepOutputs, evaluate_step};
use super::graph::{OutputRef, Recipe, RecipeStep};
use super::value::RecipeValue;
use crate::error::{MAX_SIZE, MakeError};
use crate::surface::{FULL_DETAIL, complete};

impl Recipe {
    /// Makes the material, `size × size` texels: base colour (sRGB), normal (+Y up), height, roughness and ambient
    /// occlusion.
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
        make(self, size)
    }

    /// Returns the most memory that [`Recipe::make`] takes for this size, in bytes, about.
    #[must_use]
    pub fn bytes(&self, size: u32) -> u64 {
        bytes(self, size)
    }
}

fn make(recipe: &Recipe, size: u32) -> Result<MapSet, MakeError> {
    let fine = FULL_DETAIL.div_ceil(size) as usize;
    let n = size as usize * fine;
    let [height, color, roughness] = evaluate_steps(recipe, n);
    let mut height = downsampled(height.channel(0), n, fine, |h| h.max(0.0).min(1.0));
    // NaN, of a formula that divides by 0.
    height.iter_mut().for_each(|h| *h = h.max(0.0));
    let roughness = downsampled(roughness.channel(0), n, fine, |r| r.max(0.0).min(1.0));
    let channels: [Vec<f32>; 3] = [0, 1, 2].map(|k| {
        let clamp01 = |c: f32| c.max(0.0).min(1.0);
        if fine == 1 {
            return downsampled(color.channel(k), n, fine, clamp01);
        }
        let mut light = downsampled(color.channel(k), n, fine, |c| srgb_to_linear(clamp01(c)));
        light.par_iter_mut().for_each(|c| *c = linear_to_srgb(*c));
        light
    });
    let [r, g, b] = &channels;
    let color = (0..r.len()).into_par_iter().map(|i| [r[i], g[i], b[i], 1.0]).collect();
    complete(size, height, color, roughness, recipe.height_scale)
}

/// Downsamples by the mean of `fine × fine` values.
fn downsampled(values: &[f32], n: usize, fine: usize, clamp01: impl Fn(f32) -> f32 + Sync) -> Vec<f32> {
    let size = n / fine;
    let weight = 1.0 / (fine * fine) as f32;
    let mut means = vec![0.0f32; size * size];
    means.par_chunks_mut(size).enumerate().for_each(|(y, out)| {
        for line in values[y * fine * n..(y + 1) * fine * n].chunks_exact(n) {
            for (out, group) in out.iter_mut().zip(line.chunks_exact(fine)) {
                for &value in group {
                    *out += weight * clamp01(value);
                }
            }
        }
    });
    means
}

/// Returns for each step the last one that reads it; the outputs of the recipe are read at the very end.
fn last_uses(recipe: &Recipe) -> Vec<usize> {
    let mut last = vec![0; recipe.steps.len()];
    for (k, step) in recipe.steps.iter().enumerate() {
        for input in &step.inputs {
            last[input.step] = k;
        }
    }
    for output in [recipe.height, recipe.color, recipe.roughness] {
        last[output.step] = usize::MAX;
    }
    last
}

fn bytes(recipe: &Recipe, size: u32) -> u64 {
    let last = last_uses(recipe);
    let channels = |step: &RecipeStep| -> u64 {
        let wanted = step.wanted.iter().filter(|w| **w).count() as u64;
        if step.is_color { 3 * wanted } else { wanted }
    };
    let (mut held, mut most) = (0, 0);
    for (k, step) in recipe.steps.iter().enumerate() {
        held += channels(step);
        most = most.max(held);
        held -= (0..=k).filter(|&i| last[i] == k).map(|i| channels(&recipe.steps[i])).sum::<u64>();
    }
    let n = u64::from(size) * u64::from(FULL_DETAIL.div_ceil(size.max(1)));
    // A blur has two more of its own; in the end the outputs and the maps are there together.
    n * n * 4 * (most + 2).max(5) + u64::from(size).pow(2) * 64
}

/// Evaluates all steps: height, colour and roughness, `n × n`.
fn evaluate_steps(recipe: &Recipe, n: usize) -> [RecipeValue; 3] {
    let last = last_uses(recipe);
    let mut step_outputs: Vec<StepOutputs> = Vec::new();
    for (k, step) in recipe.steps.iter().enumerate() {
        let inputs: Vec<&RecipeValue> =
            step.inputs.iter().filter_map(|input| step_outputs[input.step][input.port].as_ref()).collect();
        let outputs = evaluate_step(step, &inputs, n);
        step_outputs.push(outputs);
        for i in 0..=k {
            if last[i] == k {
                step_outputs[i].clear();
            }
        }
    }
    let mut take = |output: OutputRef, keep: bool| {
        let value = &mut step_outputs[output.step][output.port];
        if keep { value.clone() } else { value.take() }.unwrap_or(RecipeValue::Number(Vec::new()))
    };
    // One output may be two maps.
    let height = take(recipe.height, recipe.height == recipe.color || recipe.height == recipe.roughness);
    let color = take(recipe.color, recipe.color == recipe.roughness);
    [height, color, take(recipe.roughness, false)]
}
