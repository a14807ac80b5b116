//! Evaluation of one step: its operation at every texel of an `n × n` map.

use rayon::prelude::*;
use relievo_map::{Grid, HeightMap, OcclusionOptions, Wrap, ambient_occlusion};

use super::erosion::{Erosion, GRID};
use super::formula::{self, CHUNK, Expr};
use super::graph::RecipeStep;
use super::operation::{Operation, Shape, ShapeKind};
use super::value::RecipeValue;
use crate::blur::gaussian;
use crate::curve::mix;
use crate::noise::{HashRng, wrap_unit};
use crate::pattern::{Voronoi, border_random, sdf};

/// The outputs of a step; `None` where no step or map needs one.
pub(super) type StepOutputs = Vec<Option<RecipeValue>>;

/// Evaluates a step whose inputs are all there, at a phase of the recipe's loop.
pub(super) fn evaluate_step(step: &RecipeStep, inputs: &[&RecipeValue], n: usize, phase: f64) -> StepOutputs {
    let one = |value| vec![Some(value)];
    match &step.operation {
        Operation::Noise { fractal, .. } if inputs.is_empty() => {
            one(RecipeValue::Number(rows(n, |y, out| fractal.row((y as f32 + 0.5) / n as f32, phase, out))))
        }
        Operation::Noise { fractal, warp } => {
            let octaves = fractal.octaves(1.0 / n as f32, phase);
            let coordinates = WarpedUv::new(inputs, *warp, n);
            one(RecipeValue::Number(rows(n, |y, out| {
                for (x, out) in out.iter_mut().enumerate() {
                    let [u, v] = coordinates.at(x, y);
                    *out = fractal.sample(&octaves, u, v);
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
        Operation::Formula(expr) => one(formula(expr, step.is_color, inputs, n, phase)),
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
    let mut step_outputs: Vec<Option<Vec<f32>>> =
        step.wanted.iter().map(|wanted| wanted.then(|| vec![0.0; n * n])).collect();
    // One row of each at a time.
    let mut lines: Vec<Vec<(usize, &mut [f32])>> = (0..n).map(|_| Vec::new()).collect();
    for (port, values) in step_outputs.iter_mut().enumerate() {
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
    step_outputs.into_iter().map(|values| values.map(RecipeValue::Number)).collect()
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

fn formula(expr: &Expr, is_color: bool, inputs: &[&RecipeValue], n: usize, phase: f64) -> RecipeValue {
    each_channel(is_color, |channel| {
        rows(n, |row, out| {
            for (piece, out) in out.chunks_mut(CHUNK).enumerate() {
                let phase = phase as f32;
                let location = formula::ChunkLocation { size: n, row, column: piece * CHUNK, channel, phase };
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
