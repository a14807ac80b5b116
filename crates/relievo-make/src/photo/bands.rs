//! Hints taken apart by scale, and smoothing that keeps edges. Wide blurs work on fewer texels.

use rayon::prelude::*;
use relievo_map::{Grid, Wrap};

use super::options::BANDS;
use super::statistics::spread;
use crate::blur::gaussian;
use crate::edit::{add_resized, resized};

/// Clamp of a layer, in standard deviations: specks must not outweigh everything.
const MOST: f32 = 2.0;
/// Standard deviation of a blur, in texels, after which half the texels hold the rest of the detail.
const SMOOTH: f32 = 4.0;
/// Sides shorter than this are not halved.
const LEAST_SIDE: u32 = 64;

/// Downsamples for a blur of `sigma` texels, done or to come: by powers of two, as long as `sigma` stays at least
/// [`SMOOTH`].
fn smaller(grid: &Grid<f32>, sigma: f32, wrap: Wrap) -> Grid<f32> {
    let (mut width, mut height, mut sigma) = (grid.width(), grid.height(), sigma);
    while sigma >= 2.0 * SMOOTH && width.min(height) >= LEAST_SIDE {
        (width, height, sigma) = (width.div_ceil(2), height.div_ceil(2), 0.5 * sigma);
    }
    resized(grid, width, height, wrap)
}

/// Blurs with a Gaussian of `sigma`, a fraction of the width. The result may have fewer texels.
fn blurred(grid: &Grid<f32>, sigma: f32, wrap: Wrap) -> Grid<f32> {
    let mut small = smaller(grid, sigma * grid.width() as f32, wrap);
    let width = small.width();
    gaussian(small.texels_mut(), width as usize, sigma * width as f32, wrap);
    small
}

/// Subtracts a blur of `flatten`, a fraction of the width, and divides by the standard deviation; returns that as well.
pub(super) fn flattened(mut values: Grid<f32>, flatten: f32, wrap: Wrap) -> (Grid<f32>, f32) {
    if flatten > 0.0 {
        let around = blurred(&values, flatten, wrap);
        add_resized(&mut values, &around, -1.0, wrap);
    }
    let (mean, deviation) = spread(values.texels());
    // A picture of one colour has no hints, only rounding.
    let scale = if deviation > 1e-4 { 1.0 / deviation } else { 0.0 };
    values.texels_mut().par_iter_mut().for_each(|v| *v = ((*v - mean) * scale).max(-MOST).min(MOST));
    (values, deviation)
}

/// Standard deviation of the Gaussian that ends band `k`, as a fraction of the width.
fn sigma(k: usize) -> f32 {
    (1u32 << k) as f32 / 1024.0
}

/// Adds the bands of `layer` to `heights`, each with its weight. The rest beyond the coarsest band has that one's weight.
///
/// Band k is blur k − 1 minus blur k, so the sum is the layer times the first weight, plus each blur times the difference of
/// the weights of the next band and its own. Each blur starts from the one before, as variances add up, with fewer texels;
/// coarse sums are upsampled into finer ones in the end (Burt and Adelson, "The Laplacian pyramid as a compact image code",
/// 1983).
pub(super) fn add_bands(heights: Grid<f32>, layer: Grid<f32>, weights: &[f32; BANDS], wrap: Wrap) -> Grid<f32> {
    let (mut sum, mut level, mut done) = (heights, layer, 0.0f32);
    let mut finer = Vec::new();
    add(&mut sum, &level, weights[0]);
    for (k, pair) in weights.windows(2).enumerate() {
        let share = pair[1] - pair[0];
        if share == 0.0 {
            continue;
        }
        let width = level.width();
        let step = (sigma(k).powi(2) - done.powi(2)).sqrt() * width as f32;
        gaussian(level.texels_mut(), width as usize, step, wrap);
        done = sigma(k);
        add(&mut sum, &level, share);
        let small = smaller(&level, done * width as f32, wrap);
        if small.width() != width {
            let empty = Grid::filled(small.width(), small.height(), 0.0);
            finer.push(std::mem::replace(&mut sum, empty));
            level = small;
        }
    }
    drop(level);
    for mut finer in finer.into_iter().rev() {
        add_resized(&mut finer, &sum, 1.0, wrap);
        sum = finer;
    }
    sum
}

/// Adds `weight` times `grid`, of the same size.
pub(super) fn add(sum: &mut Grid<f32>, grid: &Grid<f32>, weight: f32) {
    sum.texels_mut().par_iter_mut().zip(grid.texels()).for_each(|(s, v)| *s += weight * v);
}

/// Returns the local contrast of a layer at its finest scale, 1 on average, with fewer texels than the layer.
pub(super) fn contrast(layer: &Grid<f32>, wrap: Wrap) -> Grid<f32> {
    let mut detail = layer.clone();
    let width = detail.width();
    gaussian(detail.texels_mut(), width as usize, sigma(1) * width as f32, wrap);
    detail.texels_mut().par_iter_mut().zip(layer.texels()).for_each(|(d, v)| *d = (v - *d).abs());
    let mut contrast = blurred(&detail, sigma(2), wrap);
    let mean = spread(contrast.texels()).0.max(1e-6);
    contrast.texels_mut().par_iter_mut().for_each(|c| *c /= mean);
    contrast
}

/// Returns the skewness of a layer without its finest detail: positive if the smaller part of the texels has the high
/// values. The third moment divided by the cube of the standard deviation.
pub(super) fn skewness(layer: &Grid<f32>, wrap: Wrap) -> f32 {
    let soft = blurred(layer, sigma(2), wrap);
    let (mean, deviation) = spread(soft.texels());
    let cubes = soft.map(|v| ((v - mean) / deviation.max(1e-6)).powi(3));
    spread(cubes.texels()).0
}

/// Smooths within `radius`, a fraction of the width, and keeps edges that stand out by more than a tenth of the range: a guided
/// filter (He, Sun and Tang, "Guided image filtering", 2010), guided by the heights themselves, with a bell for its window.
/// Its coefficients are smooth and need fewer texels (He and Sun, "Fast guided filter", 2015).
pub(super) fn guided(heights: &mut Grid<f32>, radius: f32, wrap: Wrap) {
    const EDGE: f32 = 0.1;
    let mut mean = blurred(heights, radius, wrap);
    let mut squares = heights.clone();
    squares.texels_mut().par_iter_mut().for_each(|h| *h *= *h);
    let mut gain = blurred(&squares, radius, wrap);
    drop(squares);
    gain.texels_mut().par_iter_mut().zip(mean.texels_mut()).for_each(|(g, m)| {
        let variance = (*g - *m * *m).max(0.0);
        *g = variance / (variance + EDGE * EDGE);
        *m *= 1.0 - *g;
    });
    let (width, sigma) = (gain.width() as usize, radius * gain.width() as f32);
    for grid in [&mut gain, &mut mean] {
        gaussian(grid.texels_mut(), width, sigma, wrap);
    }
    let gain = resized(&gain, heights.width(), heights.height(), wrap);
    heights.texels_mut().par_iter_mut().zip(gain.texels()).for_each(|(h, g)| *h *= g);
    drop(gain);
    add_resized(heights, &mean, 1.0, wrap);
}
