//! Evaluation of a recipe: step by step, each on all cores, each result freed after its last use.

use rayon::prelude::*;
use relievo_map::{Grid, HeightMap, MapSet, OcclusionOptions, Wrap, ambient_occlusion, linear_to_srgb, srgb_to_linear};

use super::erosion::{Erosion, GRID};
use super::formula::{self, CHUNK, Expr};
use super::graph::{OutputRef, Recipe, RecipeStep};
use super::operation::{Operation, Shape, ShapeKind};
use super::value::RecipeValue;
use crate::blur::gaussian;
use crate::curve::mix;
use crate::error::{MAX_SIZE, MakeError};
use crate::noise::{HashRng, wrap_unit};
use crate::pattern::{Voronoi, border_random, sdf};
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

/// The outputs of a step; `None` where no step or map needs one.
type StepOutputs = Vec<Option<RecipeValue>>;

fn make(recipe: &Recipe, size: u32) -> Result<MapSet, MakeError> {
    let fine = FULL_DETAIL.div_ceil(size) as usize;
    let n = size as usize * fine;
    let [height, color, roughness] = follow(recipe, n);
    let mut height = averaged(height.channel(0), n, fine, |h| h.max(0.0).min(1.0));
    // NaN, of a formula that divides by 0.
    height.iter_mut().for_each(|h| *h = h.max(0.0));
    let roughness = averaged(roughness.channel(0), n, fine, |r| r.max(0.0).min(1.0));
    let channels: [Vec<f32>; 3] = [0, 1, 2].map(|k| {
        let tame = |c: f32| c.max(0.0).min(1.0);
        if fine == 1 {
            return averaged(color.channel(k), n, fine, tame);
        }
        let mut light = averaged(color.channel(k), n, fine, |c| srgb_to_linear(tame(c)));
        light.par_iter_mut().for_each(|c| *c = linear_to_srgb(*c));
        light
    });
    let [r, g, b] = &channels;
    let color = (0..r.len()).into_par_iter().map(|i| [r[i], g[i], b[i], 1.0]).collect();
    complete(size, height, color, roughness, recipe.height_scale)
}

/// Downsamples by the mean of `fine × fine` values.
fn averaged(values: &[f32], n: usize, fine: usize, tame: impl Fn(f32) -> f32 + Sync) -> Vec<f32> {
    let size = n / fine;
    let weight = 1.0 / (fine * fine) as f32;
    let mut means = vec![0.0f32; size * size];
    means.par_chunks_mut(size).enumerate().for_each(|(y, out)| {
        for line in values[y * fine * n..(y + 1) * fine * n].chunks_exact(n) {
            for (out, group) in out.iter_mut().zip(line.chunks_exact(fine)) {
                for &value in group {
                    *out += weight * tame(value);
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
fn follow(recipe: &Recipe, n: usize) -> [RecipeValue; 3] {
    let last = last_uses(recipe);
    let mut made: Vec<StepOutputs> = Vec::new();
    for (k, step) in recipe.steps.iter().enumerate() {
        let inputs: Vec<&RecipeValue> =
            step.inputs.iter().filter_map(|input| made[input.step][input.port].as_ref()).collect();
        let outputs = perform(step, &inputs, n);
        made.push(outputs);
        for i in 0..=k {
            if last[i] == k {
                made[i].clear();
            }
        }
    }
    let mut take = |output: OutputRef, again: bool| {
        let field = &mut made[output.step][output.port];
        if again { field.clone() } else { field.take() }.unwrap_or(RecipeValue::Number(Vec::new()))
    };
    // One output may be two maps.
    let height = take(recipe.height, recipe.height == recipe.color || recipe.height == recipe.roughness);
    let color = take(recipe.color, recipe.color == recipe.roughness);
    [height, color, take(recipe.roughness, false)]
}

fn perform(step: &RecipeStep, inputs: &[&RecipeValue], n: usize) -> StepOutputs {
    let one = |field| vec![Some(field)];
    match &step.operation {
        Operation::Noise { fractal, .. } if inputs.is_empty() => {
            one(RecipeValue::Number(rows(n, |y, out| fractal.row((y as f32 + 0.5) / n as f32, out))))
        }
        Operation::Noise { fractal, warp } => {
            let texel = 1.0 / n as f32;
            let coordinates = WarpedUv::new(inputs, *warp, n);
            one(RecipeValue::Number(rows(n, |y, out| {
                for (x, out) in out.iter_mut().enumerate() {
                    let [u, v] = coordinates.at(x, y);
                    *out = fractal.at(u, v, texel);
                }
            })))
        }
        Operation::Cells { count, relax, warp, seed } => {
            cells(step, &Voronoi::relaxed(*count, *relax, *seed), &WarpedUv::new(inputs, *warp, n), *seed, n)
        }
        Operation::Hexagons { columns, rows, warp, seed } => {
            cells(step, &Voronoi::hexagons(*columns, *rows), &WarpedUv::new(inputs, *warp, n), *seed, n)
        }
        Operation::Bricks { masonry, warp } => {
            let coordinates = WarpedUv::new(inputs, *warp, n);
            ports(step, n, |x, y| {
                let [u, v] = coordinates.at(x, y);
                let p = masonry.at(u, v);
                let [r, s, t] = cell_random(p.brick, masonry.seed);
                [p.edge, r, s, t, p.along, p.across, p.from_middle[0], p.from_middle[1], f32::from(p.is_upright)]
            })
        }
        Operation::Shape(shape) => {
            let coordinates = WarpedUv::new(inputs, shape.warp, n);
            ports(step, n, |x, y| shape_at(shape, coordinates.at(x, y)))
        }
        Operation::Formula(expr) => one(formula(expr, step.is_color, inputs, n)),
        Operation::Gradient(stops) => one(gradient(stops, inputs[0], n)),
        Operation::Blur(radius) => {
            let blurred = |k| {
                let mut values = inputs[0].channel(k).to_vec();
                gaussian(&mut values, n, radius * n as f32, Wrap::Repeat);
                values
            };
            one(each_channel(step.is_color, blurred))
        }
        Operation::Warp(amount) => {
            let coordinates = WarpedUv::new(&inputs[1..], *amount, n);
            one(each_channel(step.is_color, |k| {
                let values = inputs[0].channel(k);
                rows(n, |y, out| {
                    for (x, out) in out.iter_mut().enumerate() {
                        *out = bilinear(values, n, coordinates.at(x, y));
                    }
                })
            }))
        }
        Operation::Occlusion(height_scale) => {
            let side = n as u32;
            let texels = inputs[0].channel(0);
            let map = HeightMap::new(Grid::from_fn(side, side, |x, y| texels[y as usize * n + x as usize]));
            let options = OcclusionOptions { height_scale: *height_scale, ..OcclusionOptions::default() };
            one(RecipeValue::Number(ambient_occlusion(&map, &options).into_grid().into_texels()))
        }
        Operation::Erode(erosion) => erode(erosion, inputs[0].channel(0), n),
    }
}

/// Fills `n × n` values, row by row on all cores.
fn rows(n: usize, fill: impl Fn(usize, &mut [f32]) + Sync) -> Vec<f32> {
    let mut values = vec![0.0; n * n];
    values.par_chunks_mut(n).enumerate().for_each(|(y, out)| fill(y, out));
    values
}

fn each_channel(is_color: bool, f: impl Fn(usize) -> Vec<f32>) -> RecipeValue {
    if is_color { RecipeValue::Color([f(0), f(1), f(2)]) } else { RecipeValue::Number(f(0)) }
}

/// Fills all needed outputs of an operation that has several numbers at each texel.
fn ports<const N: usize>(step: &RecipeStep, n: usize, at: impl Fn(usize, usize) -> [f32; N] + Sync) -> StepOutputs {
    let mut made: Vec<Option<Vec<f32>>> = step.wanted.iter().map(|wanted| wanted.then(|| vec![0.0; n * n])).collect();
    // One row of each at a time.
    let mut lines: Vec<Vec<(usize, &mut [f32])>> = (0..n).map(|_| Vec::new()).collect();
    for (port, values) in made.iter_mut().enumerate() {
        for (line, row) in lines.iter_mut().zip(values.iter_mut().flat_map(|values| values.chunks_exact_mut(n))) {
            line.push((port, row));
        }
    }
    lines.into_par_iter().enumerate().for_each(|(y, mut line)| {
        for x in 0..n {
            let values = at(x, y);
            for (port, row) in &mut line {
                row[x] = values[*port];
            }
        }
    });
    made.into_iter().map(|values| values.map(RecipeValue::Number)).collect()
}

/// Coordinates of each texel, offset by two values times an amount (domain warping).
struct WarpedUv<'a> {
    by: Option<[&'a [f32]; 2]>,
    amount: f32,
    n: usize,
}

impl<'a> WarpedUv<'a> {
    fn new(by: &[&'a RecipeValue], amount: f32, n: usize) -> Self {
        let by = if let [a, b] = by { Some([a.channel(0), b.channel(0)]) } else { None };
        Self { by, amount, n }
    }

    fn at(&self, x: usize, y: usize) -> [f32; 2] {
        let [u, v] = [x, y].map(|i| (i as f32 + 0.5) / self.n as f32);
        match self.by {
            None => [u, v],
            Some([a, b]) => {
                let i = y * self.n + x;
                [u + self.amount * a[i], v + self.amount * b[i]]
            }
        }
    }
}

/// Returns three random numbers in [0, 1) of a cell.
fn cell_random(cell: u32, seed: u32) -> [f32; 3] {
    let mut rng = HashRng::new(cell, seed);
    [rng.unit(), rng.unit(), rng.unit()]
}

fn cells(step: &RecipeStep, cells: &Voronoi, coordinates: &WarpedUv<'_>, seed: u32, n: usize) -> StepOutputs {
    ports(step, n, |x, y| {
        let [u, v] = coordinates.at(x, y);
        let p = cells.at(u, v);
        let [r, s, t] = cell_random(p.cell, seed);
        let [dx, dy] = p.from_site;
        [p.edge, r, s, t, dx, dy, dx.hypot(dy), border_random(p.cell, p.neighbor, seed)]
    })
}

fn shape_at(shape: &Shape, uv: [f32; 2]) -> [f32; 6] {
    let ([x, y], [i, j]) = sdf::repeated(uv, shape.columns, shape.rows, shape.stagger);
    let [x, y] = sdf::turned([x - shape.offset[0], y - shape.offset[1]], shape.angle);
    let p = [x, y];
    let d = match shape.kind {
        ShapeKind::Circle { radius } => sdf::circle(p, radius),
        ShapeKind::Rectangle { half } => sdf::rectangle(p, half),
        ShapeKind::Polygon { radius, sides } => sdf::polygon(p, radius, sides),
        ShapeKind::Star { radius, inner, points } => sdf::star(p, radius, inner, points),
        ShapeKind::Line { half_length, radius } => sdf::segment(p, [-half_length, 0.0], [half_length, 0.0], radius),
    };
    let [r, s, t] = cell_random(j * 1024 + i, shape.seed);
    [sdf::rounded(d, shape.round), r, s, t, x, y]
}

fn formula(expr: &Expr, is_color: bool, inputs: &[&RecipeValue], n: usize) -> RecipeValue {
    each_channel(is_color, |channel| {
        rows(n, |row, out| {
            for (piece, out) in out.chunks_mut(CHUNK).enumerate() {
                let location = formula::ChunkLocation { size: n, row, column: piece * CHUNK, channel };
                formula::evaluate(expr, inputs, location, out);
            }
        })
    })
}

fn gradient(stops: &[(f32, [f32; 3])], input: &RecipeValue, n: usize) -> RecipeValue {
    let values = input.channel(0);
    each_channel(true, |k| {
        rows(n, |y, out| {
            for (out, &value) in out.iter_mut().zip(&values[y * n..(y + 1) * n]) {
                let above = stops.partition_point(|stop| stop.0 <= value);
                *out = match (above.checked_sub(1).map(|i| stops[i]), stops.get(above)) {
                    (Some((from, a)), Some(&(to, b))) => mix(a[k], b[k], (value - from) / (to - from)),
                    (Some((_, color)), None) => color[k],
                    (None, _) => stops[0].1[k],
                };
            }
        })
    })
}

/// Samples an `n × n` map that repeats, bilinearly.
fn bilinear(values: &[f32], n: usize, [u, v]: [f32; 2]) -> f32 {
    let place = |u: f32| {
        let x = wrap_unit(u) * n as f32 - 0.5;
        let i = x.floor();
        let near = (i as i32).rem_euclid(n as i32) as usize;
        (near, (near + 1) % n, x - i)
    };
    let ((left, right, fx), (top, bottom, fy)) = (place(u), place(v));
    let line = |y: usize| mix(values[y * n + left], values[y * n + right], fx);
    mix(line(top), line(bottom), fy)
}

/// Erodes the ground on a grid of fixed size, and adds the change to the finer ground. Outputs height and flow.
fn erode(erosion: &Erosion, ground: &[f32], n: usize) -> StepOutputs {
    let mut coarse = ground.to_vec();
    // Detail finer than the coarse grid must not alias.
    gaussian(&mut coarse, n, 0.4 * (n as f32 / GRID as f32 - 1.0), Wrap::Repeat);
    let mut sampled = vec![0.0; GRID * GRID];
    for (k, out) in sampled.iter_mut().enumerate() {
        let [u, v] = [k % GRID, k / GRID].map(|i| (i as f32 + 0.5) / GRID as f32);
        *out = bilinear(&coarse, n, [u, v]);
    }
    drop(coarse);
    let eroded = erosion.run(&sampled);
    let fine = |values: &[f32]| {
        rows(n, |y, out| {
            for (x, out) in out.iter_mut().enumerate() {
                *out = cubic(values, [x, y].map(|i| (i as f32 + 0.5) / n as f32 * GRID as f32 - 0.5));
            }
        })
    };
    let mut height = fine(&eroded.change);
    height.par_iter_mut().zip(ground).for_each(|(h, g)| *h += g);
    vec![Some(RecipeValue::Number(height)), Some(RecipeValue::Number(fine(&eroded.flow)))]
}

/// Samples with a uniform cubic B-spline: smooth, so that no grid shows on the slopes.
fn cubic(values: &[f32], at: [f32; 2]) -> f32 {
    let weights = |t: f32| {
        let s = 1.0 - t;
        [s * s * s, 3.0 * t * t * t - 6.0 * t * t + 4.0, 3.0 * s * s * s - 6.0 * s * s + 4.0, t * t * t]
            .map(|w| w / 6.0)
    };
    let [i, j] = at.map(f32::floor);
    let (wx, wy) = (weights(at[0] - i), weights(at[1] - j));
    let wrap = |x: i32| x.rem_euclid(GRID as i32) as usize;
    let mut sum = 0.0;
    for (dy, wy) in wy.iter().enumerate() {
        let row = wrap(j as i32 + dy as i32 - 1) * GRID;
        for (dx, wx) in wx.iter().enumerate() {
            sum += wy * wx * values[row + wrap(i as i32 + dx as i32 - 1)];
        }
    }
    sum
}
