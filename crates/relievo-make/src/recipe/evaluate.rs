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
        self.make_at(size, 0.0)
    }

    /// Makes the material as it is at a phase of its loop: 0 is the beginning, 1 the same again, to the last bit. Otherwise as
    /// [`Recipe::make`].
    ///
    /// # Errors
    /// If `size` is not 1 to [`MAX_SIZE`].
    pub fn make_at(&self, size: u32, phase: f64) -> Result<MapSet, MakeError> {
        check_size(size)?;
        make(self, size, phase)
    }

    /// Returns the most memory that [`Recipe::make`] takes for this size, in bytes, about.
    #[must_use]
    pub fn bytes(&self, size: u32) -> u64 {
        bytes(self, size)
    }
}

pub(super) fn check_size(size: u32) -> Result<(), MakeError> {
    if size == 0 || size > MAX_SIZE { Err(MakeError::Size { size }) } else { Ok(()) }
}

/// Samples along each side of a texel, of which it is the mean.
pub(super) fn samples_per_side(size: u32) -> u32 {
    FULL_DETAIL.div_ceil(size)
}

fn make(recipe: &Recipe, size: u32, phase: f64) -> Result<MapSet, MakeError> {
    let fine = samples_per_side(size) as usize;
    let n = size as usize * fine;
    let outputs = [recipe.height, recipe.color, recipe.roughness];
    let mut values = evaluate_steps(&recipe.steps, &outputs, n, phase).into_iter();
    let mut next = || values.next().unwrap_or(RecipeValue::Number(Vec::new()));
    let (height, color, roughness) = (next(), next(), next());
    let height = heights(&height, n, fine);
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

/// Downsamples heights and clamps them to 0..1.
pub(super) fn heights(values: &RecipeValue, n: usize, fine: usize) -> Vec<f32> {
    let mut height = downsampled(values.channel(0), n, fine, |h| h.max(0.0).min(1.0));
    // NaN, of a formula that divides by 0.
    height.iter_mut().for_each(|h| *h = h.max(0.0));
    height
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

/// Returns for each step the last one that reads it; the outputs are read at the very end.
fn last_uses(steps: &[RecipeStep], outputs: &[OutputRef]) -> Vec<usize> {
    let mut last = vec![0; steps.len()];
    for (k, step) in steps.iter().enumerate() {
        for input in &step.inputs {
            last[input.step] = k;
        }
    }
    for output in outputs {
        last[output.step] = usize::MAX;
    }
    last
}

fn bytes(recipe: &Recipe, size: u32) -> u64 {
    let last = last_uses(&recipe.steps, &[recipe.height, recipe.color, recipe.roughness]);
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
    let n = u64::from(size) * u64::from(samples_per_side(size.max(1)));
    // A blur has two more of its own; in the end the outputs and the maps are there together.
    n * n * 4 * (most + 2).max(5) + u64::from(size).pow(2) * 64
}

/// Evaluates steps at a phase of their loop: the values of `outputs`, `n × n`.
pub(super) fn evaluate_steps(steps: &[RecipeStep], outputs: &[OutputRef], n: usize, phase: f64) -> Vec<RecipeValue> {
    let last = last_uses(steps, outputs);
    let mut step_outputs: Vec<StepOutputs> = Vec::new();
    for (k, step) in steps.iter().enumerate() {
        let inputs: Vec<&RecipeValue> =
            step.inputs.iter().filter_map(|input| step_outputs[input.step][input.port].as_ref()).collect();
        let values = evaluate_step(step, &inputs, n, phase);
        step_outputs.push(values);
        for i in 0..=k {
            if last[i] == k {
                step_outputs[i].clear();
            }
        }
    }
    let take = |(k, output): (usize, &OutputRef)| {
        let value = &mut step_outputs[output.step][output.port];
        // One output may be two maps.
        let keep = outputs[k + 1..].contains(output);
        if keep { value.clone() } else { value.take() }.unwrap_or(RecipeValue::Number(Vec::new()))
    };
    outputs.iter().enumerate().map(take).collect()
}
