//! Pieces of the curve over the grid of cells, for the march through the pyramid.

use super::curve::{Curve, Quadratic};
use super::vector::{dot, length, sub, three, two};
use crate::exact::{Path, Quantization};
use crate::grid_line::{Line, TEXEL_CENTER};
use crate::patch::patch_crossing;
use crate::pyramid::MaxPyramid;
use crate::real::Real;

/// The distance of a chord inside a cell from the curve, in texels.
const CHORD_ERROR: f32 = 1e-3;

/// The most chords inside a cell.
const MOST_CHORDS: f32 = 32.0;

/// How much larger the denominator may be at one end of a piece than at the other.
const MOST_SLANT: f64 = 4.0;

/// A piece of the curve: at s in [0, 1] the position is `p(s)/w(s)` in texels from a cell, the height
/// `midlevel + (offset[0] + offset[1]·s)·√n(s)/w(s)`; w is positive, and u and v rise or fall all the way.
pub(super) struct CurvedPath {
    base: [i32; 2],
    step: [i32; 2],
    /// Coefficients of powers of s.
    p: [[f32; 3]; 2],
    w: [f32; 3],
    /// The squared length of the interpolated normal, times w².
    n: [f32; 5],
    offset: [f32; 2],
    midlevel: f32,
    /// The distance by which the height may be below a chord of length 1.
    sag: f32,
    texels_per_height: f32,
    quantization: Quantization,
    /// What of it lies below the highest height, in s.
    pub(super) below_lid: [f32; 2],
}

impl CurvedPath {
    /// Returns the piece between two offsets, in the order of the ray; none if u or v turn back in it, or if it is too slanted.
    /// `top`: the highest height.
    pub(super) fn new(curve: &Curve<'_>, ends: [f64; 2], pyramid: &MaxPyramid, top: f32) -> Option<Self> {
        let prism = curve.prism;
        let size = two(|k| f64::from(pyramid.size()[k]));
        // Weights in Bernstein form; their sum at the beginning is 1.
        let w = curve.bernstein(ends);
        let unit = 1.0 / (w[0][0] + w[1][0] + w[2][0]);
        let w = three(|k| three(|i| w[k][i] * unit));
        let s = three(|i| w[0][i] + w[1][i] + w[2][i]);
        let (least, most) = (s[0].min(s[1]).min(s[2]), s[0].max(s[1]).max(s[2]));
        if !(least > 0.0 && most <= MOST_SLANT * least) {
            return None;
        }
        let offset = f64::from(TEXEL_CENTER);
        let weighted = |of: [f64; 3]| three(|i| of[0] * w[0][i] + of[1] * w[1][i] + of[2] * w[2][i]);
        let corner = |k: usize, a: usize| prism.uvs[k][a] * size[a] - offset;
        let base = two(|a| weighted(three(|k| corner(k, a)))[0].floor_int());
        let p = two(|a| weighted(three(|k| corner(k, a) - f64::from(base[a]))));
        let mut step = [1; 2];
        for a in 0..2 {
            // The derivative's numerator in Bernstein form: where it keeps its sign, u or v does not turn back.
            let g = derivative(&p[a], &s);
            step[a] = if g.iter().all(|&g| g <= 0.0) { -1 } else { 1 };
            if step[a] > 0 && !g.iter().all(|&g| g >= 0.0) {
                return None;
            }
        }
        let normals = three(|axis| weighted(three(|k| prism.normals[k][axis])));
        let n = three(|axis| powers(normals[axis]));
        let product = |i: usize, j: usize| n[0][i] * n[0][j] + n[1][i] * n[1][j] + n[2][i] * n[2][j];
        let (bends, length_e) = (Bends::new(curve, &w, &s, ends), ends[1] - ends[0]);
        let single = |q: Quadratic| three(|i| q[i] as f32);
        Some(Self {
            base,
            step,
            p: two(|a| single(powers(p[a]))),
            w: single(powers(s)),
            n: [
                product(0, 0),
                2.0 * product(0, 1),
                product(1, 1) + 2.0 * product(0, 2),
                2.0 * product(1, 2),
                product(2, 2),
            ]
            .map(|x| x as f32),
            offset: [ends[0], length_e].map(|e| (e / prism.depth) as f32),
            midlevel: prism.midlevel as f32,
            sag: (bends.height / prism.depth) as f32,
            texels_per_height: (prism.depth * prism.texels_per_unit(pyramid.size())) as f32,
            quantization: Quantization::new(pyramid),
            below_lid: below_lid(
                curve,
                ends,
                three(|axis| [normals[axis][0], normals[axis][2] / s[2]]),
                f64::from(top),
                bends.normal,
            ),
        })
    }

    #[inline]
    fn denominator(&self, s: f32) -> f32 {
        value(&self.w, s)
    }

    /// Returns the distance of the chord between two places from the curve at most, in texels; see [`Curve::chord_error`].
    fn chord_error(&self, s: f32, end: f32, first: [f32; 2], last: [f32; 2]) -> f32 {
        let length = end - s;
        let parts = |q: &[f32; 3]| {
            let start = value(q, s);
            [start, start + (q[1] + 2.0 * q[2] * s) * (0.5 * length), value(q, end)]
        };
        let w = parts(&self.w);
        let least = w[0].min(w[1]).min(w[2]).max(1e-6);
        let off = |k: usize| {
            let p = parts(&self.p[k]);
            let a = p[0] + 2.0 * p[1] - w[0] * last[k] - 2.0 * w[1] * first[k];
            let b = p[2] + 2.0 * p[1] - w[2] * first[k] - 2.0 * w[1] * last[k];
            a.abs().max(b.abs()) * (0.25 / least)
        };
        off(0).max(off(1)).max(self.sag * length * length * self.texels_per_height)
    }
}

impl Path for CurvedPath {
    #[inline(always)]
    fn base(&self) -> [i32; 2] {
        self.base
    }

    #[inline(always)]
    fn step(&self) -> [i32; 2] {
        self.step
    }

    #[inline]
    fn position(&self, s: f32) -> [f32; 2] {
        let per_w = 1.0 / self.denominator(s);
        [value(&self.p[0], s) * per_w, value(&self.p[1], s) * per_w]
    }

    /// It rises or falls all the way: of the numerator less the border times w, in Bernstein form, the ends have two signs, and
    /// the root is `x/(1 + x)` with x positive.
    #[inline]
    fn crossing(&self, edge: i32, k: usize) -> f32 {
        let (edge, sign, p) = (edge as f32, self.step[k] as f32, &self.p[k]);
        let f0 = (p[0] - edge * self.w[0]) * sign;
        let f1 = f0 + 0.5 * (p[1] - edge * self.w[1]) * sign;
        let f2 = 2.0 * f1 - f0 + (p[2] - edge * self.w[2]) * sign;
        if !(f2 > 0.0) {
            return f32::INFINITY;
        }
        let start = (-f0).max(0.0);
        let root = (f1 * f1 + start * f2).sqrt();
        let [numerator, more] = if f1 >= 0.0 { [start, f1 + root] } else { [root - f1, f2] };
        numerator / (numerator + more)
    }

    #[inline]
    fn height(&self, s: f32) -> f32 {
        let [a, b, c, d, e] = self.n;
        let n = a + s * (b + s * (c + s * (d + s * e)));
        self.midlevel + (self.offset[0] + self.offset[1] * s) * n.max(0.0).sqrt() / self.denominator(s)
    }

    fn speed(&self) -> f32 {
        let (from, to) = (self.position(0.0), self.position(1.0));
        (to[0] - from[0]).hypot(to[1] - from[1])
    }

    #[inline]
    fn lowest(&self, s: f32, t_exit: f32) -> f32 {
        let length = t_exit - s;
        self.quantization.of(self.height(s).min(self.height(t_exit)) - self.sag * length * length)
    }

    /// By as many chords as keep close to the curve.
    fn patch(&self, corners: [f32; 4], cell: [i32; 2], inside: [f32; 2], s: f32, t_exit: f32) -> Option<f32> {
        let highest = corners[0].max(corners[1]).max(corners[2].max(corners[3]));
        let length = t_exit - s;
        let cell = two(|k| cell[k] as f32);
        let out = self.position(t_exit);
        let error = self.chord_error(s, t_exit, [inside[0] + cell[0], inside[1] + cell[1]], out);
        let chords = (error / CHORD_ERROR).sqrt().ceil().clamp(1.0, MOST_CHORDS);
        let (mut from, mut height) = (inside, self.height(s));
        for i in 0..chords as u32 {
            let x = (i + 1) as f32 / chords;
            let end = s + length * x;
            let position = self.position(end);
            let to = [position[0] - cell[0], position[1] - cell[1]];
            let height_after = self.height(end);
            if height.min(height_after) <= highest {
                let line = Line { uv: [0.0; 2], slope: [0.0; 2], height, dheight_ds: height_after - height };
                let at = two(|k| from[k].clamp(0.0, 1.0));
                let d = [to[0] - from[0], to[1] - from[1]];
                if let Some(x) = patch_crossing(corners, at, d, &line, 0.0, 1.0) {
                    return Some(length * ((i as f32 + x) / chords));
                }
            }
            (from, height) = (to, height_after);
        }
        None
    }
}

/// Bounds of what bends over a piece.
struct Bends {
    /// The distance by which `e·|N|` may be below its chord, scene units.
    height: f64,
    /// The distance of the interpolated normal from its chord.
    normal: f64,
}

impl Bends {
    /// An eighth of the second derivatives at most, from those of the weights.
    fn new(curve: &Curve<'_>, w: &[Quadratic; 3], s: &Quadratic, ends: [f64; 2]) -> Self {
        let least = s[0].min(s[1]).min(s[2]);
        let most = s[0].max(s[1]).max(s[2]);
        let ds = 2.0 * (s[1] - s[0]).abs().max((s[2] - s[1]).abs());
        let (mut first, mut second) = (0.0, 0.0);
        for k in 1..3 {
            let g = derivative(&w[k], s);
            let highest = g.iter().fold(0.0, |highest: f64, g| highest.max(g.abs()));
            let dg = 2.0 * (g[1] - g[0]).abs().max((g[2] - g[1]).abs());
            let lean = length(sub(curve.prism.normals[k], curve.prism.normals[0]));
            first += lean * highest / (least * least);
            second += lean * (dg * most + 2.0 * highest * ds) / (least * least * least);
        }
        let bend = second + first * first / curve.prism.shortest_normal();
        let farthest = ends[0].abs().max(ends[1].abs());
        Self { height: 0.125 * (2.0 * (ends[1] - ends[0]).abs() * first + farthest * bend), normal: 0.125 * second }
    }
}

/// Returns what of a piece lies below the highest height, in s; `normals`: each coordinate at its ends.
fn below_lid(curve: &Curve<'_>, ends: [f64; 2], normals: [[f64; 2]; 3], top: f64, bend: f64) -> [f32; 2] {
    let prism = curve.prism;
    let [from, to] = two(|i| three(|axis| normals[axis][i]));
    let turned = sub(to, from);
    // Of a chord of normals between these two nothing is shorter, and the curve of them is near it.
    let shortest = (dot(from, from).min(dot(to, to)) - 0.25 * dot(turned, turned)).max(0.0).sqrt() - bend;
    // A lid below the polygon is farthest from it where normals are longest: all of the piece is marched.
    if !(shortest > 0.0 && top > prism.midlevel) {
        return [0.0, 1.0];
    }
    let lid = (top - prism.midlevel) * prism.depth / shortest;
    let at_lid = ((lid - ends[0]) / (ends[1] - ends[0])).clamp(0.0, 1.0) as f32;
    if ends[1] < ends[0] { [at_lid, 1.0] } else { [0.0, at_lid] }
}

/// Returns the numerator of the derivative of `p/s` in Bernstein form, p and s in Bernstein form too.
fn derivative(p: &Quadratic, s: &Quadratic) -> Quadratic {
    [2.0 * (p[1] * s[0] - p[0] * s[1]), p[2] * s[0] - p[0] * s[2], 2.0 * (p[2] * s[1] - p[1] * s[2])]
}

/// Converts a quadratic in Bernstein form to coefficients of powers.
fn powers([a, b, c]: Quadratic) -> Quadratic {
    [a, 2.0 * (b - a), c - 2.0 * b + a]
}

fn value(q: &[f32; 3], s: f32) -> f32 {
    q[0] + s * (q[1] + s * q[2])
}
