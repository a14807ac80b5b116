//! Evaluation of formulas, a chunk of a row at a time.

use super::super::value::RecipeValue;
use super::expr::{Builtin, Expr, Function};
use crate::curve::{mix, smooth_max};

/// Texels per chunk: all operands fit the fastest cache.
pub(crate) const CHUNK: usize = 256;

/// An input of a formula: the whole output of a step.
pub(crate) type Input<'a> = &'a RecipeValue;

/// Location of a chunk.
#[derive(Clone, Copy)]
pub(crate) struct ChunkLocation {
    /// Texels per side.
    pub(crate) size: usize,
    pub(crate) row: usize,
    /// First column.
    pub(crate) column: usize,
    /// 0, 1, 2: red, green, blue. Numbers ignore it.
    pub(crate) channel: usize,
    /// Phase of the recipe's loop, 0 to below 1.
    pub(crate) phase: f32,
}

/// Fills `out` (at most [`CHUNK`] long) with the formula's values from `location` on.
pub(crate) fn evaluate(expr: &Expr, inputs: &[Input<'_>], location: ChunkLocation, out: &mut [f32]) {
    match expr {
        Expr::Number(number) => out.fill(*number),
        Expr::Color(color) => out.fill(color[location.channel]),
        Expr::Input(k) => {
            let start = location.row * location.size + location.column;
            out.copy_from_slice(&inputs[*k].channel(location.channel)[start..start + out.len()]);
        }
        Expr::Builtin(Builtin::Phase) => out.fill(location.phase),
        Expr::Builtin(Builtin::Texel) => out.fill(1.0 / location.size as f32),
        Expr::Builtin(Builtin::V) => out.fill((location.row as f32 + 0.5) / location.size as f32),
        Expr::Builtin(Builtin::U) => {
            for (x, out) in out.iter_mut().enumerate() {
                *out = ((location.column + x) as f32 + 0.5) / location.size as f32;
            }
        }
        Expr::Call(Function::Rgb, arguments) => {
            evaluate(&arguments[location.channel], inputs, ChunkLocation { channel: 0, ..location }, out);
        }
        Expr::Call(Function::Luminance, arguments) => {
            let mut buffer = [0.0; CHUNK];
            let channel = &mut buffer[..out.len()];
            out.fill(0.0);
            for (k, weight) in [0.2126, 0.7152, 0.0722].into_iter().enumerate() {
                evaluate(&arguments[0], inputs, ChunkLocation { channel: k, ..location }, channel);
                out.iter_mut().zip(channel.iter()).for_each(|(o, c)| *o += weight * c);
            }
        }
        Expr::Call(function, arguments) => call(*function, arguments, inputs, location, out),
    }
}

fn call(function: Function, arguments: &[Expr], inputs: &[Input<'_>], location: ChunkLocation, out: &mut [f32]) {
    evaluate(&arguments[0], inputs, location, out);
    let mut operands = [[0.0f32; CHUNK]; 2];
    for (argument, operand) in arguments[1..].iter().zip(&mut operands) {
        evaluate(argument, inputs, location, &mut operand[..out.len()]);
    }
    let [b, c] = &operands;
    let mut one = |f: fn(f32) -> f32| out.iter_mut().for_each(|a| *a = f(*a));
    match function {
        Function::Negate => return one(|a| -a),
        Function::Abs => return one(f32::abs),
        Function::Sign => {
            return one(|a| {
                if a > 0.0 {
                    1.0
                } else if a < 0.0 {
                    -1.0
                } else {
                    0.0
                }
            });
        }
        Function::Floor => return one(f32::floor),
        Function::Fract => return one(|a| a - a.floor()),
        Function::Sqrt => return one(|a| a.max(0.0).sqrt()),
        Function::Exp => return one(f32::exp),
        Function::Sin => return one(f32::sin),
        Function::Cos => return one(f32::cos),
        _ => {}
    }
    /// Every element by itself, inlined so that it can be vectorised.
    #[inline(always)]
    fn each(out: &mut [f32], b: &[f32], c: &[f32], f: impl Fn(f32, f32, f32) -> f32) {
        for ((a, &b), &c) in out.iter_mut().zip(b).zip(c) {
            *a = f(*a, b, c);
        }
    }
    match function {
        Function::Add => each(out, b, c, |a, b, _| a + b),
        Function::Subtract => each(out, b, c, |a, b, _| a - b),
        Function::Multiply => each(out, b, c, |a, b, _| a * b),
        Function::Divide => each(out, b, c, |a, b, _| a / b),
        Function::Less => each(out, b, c, |a, b, _| f32::from(a < b)),
        Function::Greater => each(out, b, c, |a, b, _| f32::from(a > b)),
        Function::Min => each(out, b, c, |a, b, _| a.min(b)),
        Function::Max => each(out, b, c, |a, b, _| a.max(b)),
        Function::Mod => each(out, b, c, |a, b, _| a - b * (a / b).floor()),
        Function::Pow => each(out, b, c, |a, b, _| a.max(0.0).powf(b)),
        Function::Hypot => each(out, b, c, |a, b, _| (a * a + b * b).sqrt()),
        Function::Atan2 => each(out, b, c, |a, b, _| a.atan2(b)),
        Function::Step => each(out, b, c, |a, b, _| f32::from(b >= a)),
        Function::Clamp => each(out, b, c, |a, b, c| a.max(b).min(c)),
        Function::Mix => each(out, b, c, mix),
        Function::Smoothstep => each(out, b, c, |low, high, x| {
            let t = ((x - low) / (high - low)).max(0.0).min(1.0);
            t * t * (3.0 - 2.0 * t)
        }),
        Function::SmoothMin => each(out, b, c, |a, b, k| -smooth_max(-a, -b, k.max(1e-9))),
        Function::SmoothMax => each(out, b, c, |a, b, k| smooth_max(a, b, k.max(1e-9))),
        // The functions of one argument, and those that choose channels, are done.
        _ => {}
    }
}
