//! The hints of a photograph, taken apart by scale.

use rayon::prelude::*;
use relievo_map::{ColorEncoding, ColorMap, Grid, GridError, Wrap, srgb_to_linear};

use super::{BANDS, ColorPick};
use crate::blur::gaussian;
use crate::edit::{add_resized, resized};

/// How many standard deviations a value may be off its surroundings: specks must not outweigh everything.
const MOST: f32 = 2.0;
/// What a blur of this many texels has left is drawn truly by splines through half the texels, or fewer.
const SMOOTH: f32 = 4.0;
/// Sides shorter than this are not halved.
const LEAST_SIDE: u32 = 64;

/// Stored colours made proportional to light.
struct Light {
    /// The sRGB curve at 1024 steps, straight between: right to 4e-7, and quicker than its power. Empty for linear files.
    curve: Vec<f32>,
}

impl Light {
    const STEPS: usize = 1024;

    fn new(encoding: ColorEncoding) -> Self {
        let srgb = encoding == ColorEncoding::Srgb;
        let steps = if srgb { 0..Self::STEPS + 2 } else { 0..0 };
        Self { curve: steps.map(|k| srgb_to_linear(k as f32 / Self::STEPS as f32)).collect() }
    }

    fn of(&self, stored: f32) -> f32 {
        // `max` first: it also turns NaN into 0.
        let c = stored.max(0.0).min(1e4);
        if self.curve.is_empty() || c > 1.0 {
            return c;
        }
        let x = c * Self::STEPS as f32;
        let k = x as usize;
        self.curve[k] + (self.curve[k + 1] - self.curve[k]) * (x - k as f32)
    }
}

fn luminance([r, g, b]: [f32; 3]) -> f32 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// A number for each texel, of its linear light. Where the picture is transparent there is no hint, but the mean.
fn each(photo: &ColorMap, f: impl Fn([f32; 3]) -> f32 + Sync) -> Result<Grid<f32>, GridError> {
    let light = Light::new(photo.encoding);
    let texels = photo.grid.texels();
    let mut values: Vec<f32> = texels.par_iter().map(|&[r, g, b, _]| f([r, g, b].map(|c| light.of(c)))).collect();
    if is_transparent(photo) {
        let seen = |(value, texel): (&f32, &[f32; 4])| if opacity(texel) > 0.5 { Some(*value) } else { None };
        let opaque: Vec<f32> = values.iter().zip(texels).filter_map(seen).collect();
        let mean = spread(&opaque).0;
        values.par_iter_mut().zip(texels).for_each(|(v, texel)| *v = mean + (*v - mean) * opacity(texel));
    }
    Grid::new(photo.grid.width(), photo.grid.height(), values)
}

/// How much of a texel is there, 0 to 1.
pub(super) fn opacity(&[.., alpha]: &[f32; 4]) -> f32 {
    alpha.max(0.0).min(1.0)
}

pub(super) fn is_transparent(photo: &ColorMap) -> bool {
    photo.grid.texels().par_iter().any(|texel| opacity(texel) < 1.0)
}

/// What is added to light before its logarithm, as what is darker is noise: a tenth of what is usual on the picture, so that a
/// dark exposure has the same hints as a bright one.
pub(super) fn black(photo: &ColorMap) -> f32 {
    const SAMPLES: usize = 1 << 14;
    let light = Light::new(photo.encoding);
    let texels = photo.grid.texels();
    let of = |&[r, g, b, _]: &[f32; 4]| luminance([r, g, b].map(|c| light.of(c)));
    let some = texels.iter().step_by(texels.len().div_ceil(SAMPLES));
    let mut samples: Vec<f32> = some.filter(|texel| opacity(texel) > 0.5).map(of).collect();
    let middle = samples.len() / 2;
    if samples.is_empty() {
        return 1.0;
    }
    let median = *samples.select_nth_unstable_by(middle, f32::total_cmp).1;
    (0.1 * median).max(2e-4)
}

/// The logarithm of the luminance: the same contrast is the same, in light and in shadow.
pub(super) fn light(photo: &ColorMap, black: f32) -> Result<Grid<f32>, GridError> {
    each(photo, |rgb| (luminance(rgb) + black).ln())
}

/// How far from grey: 0 to 1.
pub(super) fn saturation(photo: &ColorMap, black: f32) -> Result<Grid<f32>, GridError> {
    each(photo, |[r, g, b]| {
        let (least, most) = (r.min(g).min(b), r.max(g).max(b));
        (most - least) / (most + black)
    })
}

/// 1 where the photograph has the colour of `pick`, falling off as a bell with the difference.
pub(super) fn likeness(photo: &ColorMap, pick: &ColorPick) -> Result<Grid<f32>, GridError> {
    let wanted = lab(pick.color.map(srgb_to_linear));
    let tolerance = pick.tolerance.max(0.1);
    each(photo, |rgb| {
        let [l, a, b] = lab(rgb);
        let off = (0.5 * (l - wanted[0])).powi(2) + (a - wanted[1]).powi(2) + (b - wanted[2]).powi(2);
        (-off / (tolerance * tolerance)).exp()
    })
}

/// CIE Lab (1976) of linear sRGB with its white, D65.
fn lab([r, g, b]: [f32; 3]) -> [f32; 3] {
    let f = |t: f32| if t > 0.008_856 { t.cbrt() } else { 7.787 * t + 16.0 / 116.0 };
    let x = f((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505);
    let y = f(0.2126 * r + 0.7152 * g + 0.0722 * b);
    let z = f((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// The grid with fewer texels, which is enough after a blur of `sigma` texels, or before one: as few as leave [`SMOOTH`] of
/// them.
fn smaller(grid: &Grid<f32>, sigma: f32, wrap: Wrap) -> Grid<f32> {
    let (mut width, mut height, mut sigma) = (grid.width(), grid.height(), sigma);
    while sigma >= 2.0 * SMOOTH && width.min(height) >= LEAST_SIDE {
        (width, height, sigma) = (width.div_ceil(2), height.div_ceil(2), 0.5 * sigma);
    }
    resized(grid, width, height, wrap)
}

/// A blur with a bell of `sigma`, a fraction of the width. It may have fewer texels.
fn blurred(grid: &Grid<f32>, sigma: f32, wrap: Wrap) -> Grid<f32> {
    let mut small = smaller(grid, sigma * grid.width() as f32, wrap);
    let width = small.width();
    gaussian(small.texels_mut(), width as usize, sigma * width as f32, wrap);
    small
}

/// `values` without what is wider than `flatten`, a fraction of the width, in standard deviations; and what one is.
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

/// The standard deviation of the bell that ends band `k`, as a fraction of the width.
fn sigma(k: usize) -> f32 {
    (1u32 << k) as f32 / 1024.0
}

/// Adds the bands of `layer` to `heights`, each with its weight. What is left beyond the coarsest band has that one's weight.
///
/// Band k is what blur k takes away of blur k − 1, so the sum of all is the layer times the first weight, and each blur times
/// the weight of the next band less that of its own. Each blur goes on from the one before, as variances add up, and with
/// fewer texels: coarse sums are drawn into finer ones in the end (Burt and Adelson, "The Laplacian pyramid as a compact image
/// code", 1983).
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

/// How much a layer changes over the finest distances, 1 on average. It has fewer texels than the layer.
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

/// Whether the lesser part of a layer, without its finest detail, is the greater in value (positive) or the smaller
/// (negative): the third moment by the cube of the standard deviation.
pub(super) fn skewness(layer: &Grid<f32>, wrap: Wrap) -> f32 {
    let soft = blurred(layer, sigma(2), wrap);
    let (mean, deviation) = spread(soft.texels());
    let cubes = soft.map(|v| ((v - mean) / deviation.max(1e-6)).powi(3));
    spread(cubes.texels()).0
}

/// Mean and standard deviation; of nothing 0. Summed run by run in a fixed order, so that threads do not matter.
pub(super) fn spread(values: &[f32]) -> (f32, f32) {
    const RUN: usize = 1 << 14;
    let sums: Vec<[f64; 2]> = values
        .par_chunks(RUN)
        .map(|run| run.iter().fold([0.0, 0.0], |[s, q], &v| [s + f64::from(v), q + f64::from(v) * f64::from(v)]))
        .collect();
    let [sum, squares] = sums.iter().fold([0.0, 0.0], |[s, q], [a, b]| [s + a, q + b]);
    let n = values.len().max(1) as f64;
    let mean = sum / n;
    (mean as f32, (squares / n - mean * mean).max(0.0).sqrt() as f32)
}

/// The values below which these shares (in percent) of all values lie.
///
/// Counts how many values fall into each of many bins, and sorts those of one bin alone.
pub(super) fn percentiles(values: &[f32], shares: [f32; 2]) -> [f32; 2] {
    const BINS: usize = 1 << 12;
    let (low, high) = values
        .par_iter()
        .fold(|| (f32::MAX, f32::MIN), |(low, high), &v| (low.min(v), high.max(v)))
        .reduce(|| (f32::MAX, f32::MIN), |a, b| (a.0.min(b.0), a.1.max(b.1)));
    if !(high > low) {
        return [low; 2];
    }
    // Rises with the value, so that bins are in order; the cast saturates.
    let bin = |v: f32| ((((v - low) / (high - low)) * BINS as f32) as usize).min(BINS - 1);
    let empty = || vec![0usize; BINS];
    let counts = values
        .par_chunks(1 << 16)
        .fold(empty, |mut counts, run| {
            run.iter().for_each(|&v| counts[bin(v)] += 1);
            counts
        })
        .reduce(empty, |mut a, b| {
            a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
            a
        });
    shares.map(|share| {
        let last = (values.len() - 1) as f64;
        let mut rank = (f64::from(share.max(0.0).min(100.0)) / 100.0 * last).round() as usize;
        let mut wanted = 0;
        while rank >= counts[wanted] {
            rank -= counts[wanted];
            wanted += 1;
        }
        let mut near: Vec<f32> = values.par_iter().copied().filter(|&v| bin(v) == wanted).collect();
        *near.select_nth_unstable_by(rank, f32::total_cmp).1
    })
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
