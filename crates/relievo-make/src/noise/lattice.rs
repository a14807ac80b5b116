//! Periodic gradient noise, a point or a whole row at a time.
//!
//! Gradient noise after Perlin ("Improving noise", SIGGRAPH 2002) with its quintic fade, on a lattice that closes after a
//! whole number of cells, so that every map made of it tiles exactly.

use super::periodic::{floor_i32, next_cell, wrap_cell};
use super::random::{hash3, unit_float};
use super::slices::Slices;
use crate::curve::fade;

/// Slope of the gradients along time, beside those along u and v: midway between two slices the standard deviation is then
/// that of a slice.
const TIME_SLOPE: f32 = 0.84;

/// Scales the raw noise so that its standard deviation is near 1/3: nearly all values lie in [-1, 1].
const GAIN: f32 = 1.75;

/// Gradient noise with `columns × rows` cells per repeat. Values are near [-1, 1], mean 0.
#[derive(Clone, Copy)]
pub(crate) struct GradientNoise {
    pub(crate) columns: u32,
    pub(crate) rows: u32,
    pub(crate) seed: u32,
    /// The moment of noise that changes.
    pub(crate) slices: Option<Slices>,
}

impl GradientNoise {
    /// Creates noise with `columns` cells along u and `rows` along v per repeat, both at least 1.
    pub(crate) fn new(columns: u32, rows: u32, seed: u32) -> Self {
        Self { columns, rows, seed, slices: None }
    }

    /// Samples the noise at (u, v); period 1 in both.
    pub(crate) fn at(&self, u: f32, v: f32) -> f32 {
        let (x, y) = (u * self.columns as f32, v * self.rows as f32);
        let (i, j) = (floor_i32(x), floor_i32(y));
        let (left, fy) = (wrap_cell(i, self.columns), y - j as f32);
        let row_pair = self.row_pair(j);
        GAIN * interpolate(
            [self.column_plane(left, row_pair, fy), self.column_plane(next_cell(left, self.columns), row_pair, fy)],
            x - i as f32,
        )
    }

    /// Adds `amplitude ×` the noise along the row at `v` to `out`, whose texel x lies at u = (x + 0.5) / length.
    ///
    /// The same as [`GradientNoise::at`] for each texel, but hashes each cell once.
    pub(crate) fn add_row(&self, v: f32, amplitude: f32, out: &mut [f32]) {
        let n = out.len();
        let y = v * self.rows as f32;
        let j = floor_i32(y);
        let (row_pair, fy) = (self.row_pair(j), y - j as f32);
        let (per_texel, per_cell) = (self.columns as f32 / n as f32, n as f32 / self.columns as f32);
        let amplitude = amplitude * GAIN;
        let first = self.column_plane(0, row_pair, fy);
        let mut left = first;
        let mut start = 0;
        for i in 0..self.columns {
            let last = i + 1 == self.columns;
            let right = if last { first } else { self.column_plane(i + 1, row_pair, fy) };
            // The first texel whose centre lies in the next cell. Where rounding takes one too many, it lies on the
            // border of the two cells, and both give the same.
            let end = if last { n } else { (((i + 1) as f32 * per_cell + 0.5) as usize).clamp(start, n) };
            let first_fx = (start as f32 + 0.5) * per_texel - i as f32;
            // Counted in i32, which processors turn into floats four at a time.
            for (k, o) in (0i32..).zip(&mut out[start..end]) {
                *o += amplitude * interpolate([left, right], first_fx + k as f32 * per_texel);
            }
            start = end;
            left = right;
        }
    }

    /// Returns the lattice's rows above and below cell row `j`.
    fn row_pair(&self, j: i32) -> [u32; 2] {
        let above = wrap_cell(j, self.rows);
        [above, next_cell(above, self.rows)]
    }

    /// Returns `[slope, level]` of the line `slope·fx + level` that the column `i` contributes, `fy` between the rows.
    fn column_plane(&self, i: u32, row_pair: [u32; 2], fy: f32) -> [f32; 2] {
        let t = fade(fy);
        let Some(Slices { seeds, offset, weight }) = self.slices else {
            let [top, bottom] = row_pair.map(|j| gradient(i, j, self.seed));
            let (a, b) = (top[1] * fy, bottom[1] * (fy - 1.0));
            return [top[0] + (bottom[0] - top[0]) * t, a + (b - a) * t];
        };
        let plane = |seed: u32, since: f32| {
            let [top, bottom] = row_pair.map(|j| gradient(i, j, seed));
            let a = top[1] * fy + top[2] * (TIME_SLOPE * since);
            let b = bottom[1] * (fy - 1.0) + bottom[2] * (TIME_SLOPE * since);
            [top[0] + (bottom[0] - top[0]) * t, a + (b - a) * t]
        };
        let (before, after) = (plane(seeds[0], offset), plane(seeds[1], offset - 1.0));
        std::array::from_fn(|k| before[k] + (after[k] - before[k]) * weight)
    }
}

/// Returns the gradient at a point of the lattice, along u, v and time: each −1 to 1.
fn gradient(i: u32, j: u32, seed: u32) -> [f32; 3] {
    hash3(i, j, seed).map(|word| 2.0 * unit_float(word) - 1.0)
}

#[inline]
fn interpolate([left, right]: [[f32; 2]; 2], fx: f32) -> f32 {
    let a = left[0] * fx + left[1];
    let b = right[0] * (fx - 1.0) + right[1];
    a + (b - a) * fade(fx)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_repeats_after_one_in_both_directions() {
        let noise = GradientNoise::new(5, 7, 3);
        for k in 0..200 {
            let (u, v) = (k as f32 / 64.0, (k * 37 % 101) as f32 / 64.0);
            assert!((noise.at(u, v) - noise.at(u + 1.0, v)).abs() < 1e-4);
            assert!((noise.at(u, v) - noise.at(u, v - 1.0)).abs() < 1e-4);
        }
    }

    #[test]
    fn changing_noise_keeps_its_spread_between_slices_and_moves_without_a_jump() {
        let at = |phase: f64| {
            let noise = GradientNoise { slices: Slices::around(3, 4, phase), ..GradientNoise::new(32, 32, 3) };
            (0..20_000).map(|k| noise.at((k % 141) as f32 / 141.0, (k / 141) as f32 / 141.0)).collect::<Vec<f32>>()
        };
        let spread = |values: &[f32]| (values.iter().map(|x| x * x).sum::<f32>() / values.len() as f32).sqrt();
        let still = spread(&at(0.0));
        for phase in [0.03, 0.0625, 0.125, 0.2, 0.99] {
            assert!((spread(&at(phase)) / still - 1.0).abs() < 0.06, "{phase}: {} {still}", spread(&at(phase)));
        }
        let step = |a: f64, b: f64| at(a).iter().zip(at(b)).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(step(0.2499, 0.2501) < 0.01 && step(0.9999, 1.0001) < 0.01 && step(0.0, 0.25) > 0.5);
        assert_eq!(at(0.0), at(1.0));
    }

    #[test]
    fn a_row_equals_its_points_whatever_the_ratio_of_cells_to_texels() {
        for (columns, n) in [(4, 64), (7, 100), (96, 257), (3, 1), (8, 5)] {
            let noise = GradientNoise { slices: Slices::around(11, n % 3, 0.6), ..GradientNoise::new(columns, 5, 11) };
            let mut row = vec![0.0; n as usize];
            noise.add_row(0.37, 0.5, &mut row);
            for (x, value) in row.iter().enumerate() {
                let expected = 0.5 * noise.at((x as f32 + 0.5) / n as f32, 0.37);
                assert!((value - expected).abs() < 1e-4, "{columns} cells, {n} texels, texel {x}");
            }
        }
    }
}
