//! Gaussian blur whose time does not depend on its width.

use rayon::prelude::*;
use relievo_map::Wrap;

/// Passes of the box filter: four come within a per cent of the Gaussian.
const PASSES: usize = 4;
/// Rows or columns filtered side by side: as many numbers as a cache line holds.
const LANES: usize = 16;

type Lanes = [f32; LANES];

/// Blurs `values` (rows of `width`) with a Gaussian of the standard deviation `sigma`, in texels; 0 or less leaves them.
///
/// Four passes of a box with fractional ends (Gwosdek, Grewenig, Bruhn and Weickert, "Theoretical foundations of Gaussian
/// convolution by extended box filtering", 2011): the variance is exact whatever `sigma` is, the time the same. Works in
/// place, with an eighth of the picture beside it.
pub(crate) fn gaussian(values: &mut [f32], width: usize, sigma: f32, wrap: Wrap) {
    if !(sigma > 0.0) || values.is_empty() {
        return;
    }
    let kernel = BoxKernel::new(sigma);
    rows(values, width, &kernel, wrap);
    columns(values, width, &kernel, wrap);
}

fn rows(values: &mut [f32], width: usize, kernel: &BoxKernel, wrap: Wrap) {
    values.par_chunks_mut(width * LANES).for_each_init(
        || (vec![[0.0; LANES]; width], Vec::new()),
        |(line, scratch), rows| {
            for (k, row) in rows.chunks_exact(width).enumerate() {
                line.iter_mut().zip(row).for_each(|(lanes, value)| lanes[k] = *value);
            }
            kernel.blur(line, scratch, wrap);
            for (k, row) in rows.chunks_exact_mut(width).enumerate() {
                row.iter_mut().zip(line.iter()).for_each(|(value, lanes)| *value = lanes[k]);
            }
        },
    );
}

fn columns(values: &mut [f32], width: usize, kernel: &BoxKernel, wrap: Wrap) {
    let height = values.len() / width;
    let batch = width.div_ceil(8).next_multiple_of(LANES);
    let lanes_at = |left: usize| left..width.min(left + LANES);
    for first in (0..width).step_by(batch) {
        let strips: Vec<(usize, Vec<Lanes>)> = (first..width.min(first + batch))
            .into_par_iter()
            .step_by(LANES)
            .map_init(Vec::new, |scratch, left| {
                let at = lanes_at(left);
                let mut line = vec![[0.0; LANES]; height];
                for (lanes, row) in line.iter_mut().zip(values.chunks_exact(width)) {
                    lanes[..at.len()].copy_from_slice(&row[at.clone()]);
                }
                kernel.blur(&mut line, scratch, wrap);
                (left, line)
            })
            .collect();
        values.par_chunks_exact_mut(width).enumerate().for_each(|(y, row)| {
            for (left, line) in &strips {
                let at = lanes_at(*left);
                row[at.clone()].copy_from_slice(&line[y][..at.len()]);
            }
        });
    }
}

/// Box filter of `2 reach + 1` texels with a fraction of one more at each end.
struct BoxKernel {
    reach: usize,
    /// Weight of the two ends; all others have 1.
    end: f32,
    /// Reciprocal of the sum of the weights.
    scale: f32,
}

impl BoxKernel {
    /// Creates the box whose variance is that of the Gaussian divided by the number of passes.
    fn new(sigma: f32) -> Self {
        let variance = f64::from(sigma).powi(2) / PASSES as f64;
        let reach = (0.5 * ((12.0 * variance + 1.0).sqrt() - 1.0)).floor();
        let full = reach * (reach + 1.0) * (2.0 * reach + 1.0) / 3.0;
        let end = (variance * (2.0 * reach + 1.0) - full) / (2.0 * ((reach + 1.0).powi(2) - variance));
        let scale = 1.0 / (2.0 * reach + 1.0 + 2.0 * end);
        Self { reach: (reach as usize).min(1 << 20), end: end as f32, scale: scale as f32 }
    }

    fn blur(&self, line: &mut [Lanes], padded: &mut Vec<Lanes>, wrap: Wrap) {
        let (n, pad) = (line.len(), self.reach + 1);
        padded.resize(n + 2 * pad, [0.0; LANES]);
        let beyond = |i: i64| wrap.index(i as i32, n as u32) as usize;
        for _ in 0..PASSES {
            padded[pad..pad + n].copy_from_slice(line);
            for k in 0..pad {
                padded[pad - 1 - k] = line[beyond(-1 - k as i64)];
                padded[pad + n + k] = line[beyond((n + k) as i64)];
            }
            // Sums in f64: a running sum must not drift.
            let mut sum = [0.0f64; LANES];
            for lanes in &padded[1..2 * pad] {
                sum.iter_mut().zip(lanes).for_each(|(s, v)| *s += f64::from(*v));
            }
            let (before, leaving, entering) = (&padded[..n], &padded[1..=n], &padded[2 * pad..]);
            for (((out, before), leaving), entering) in line.iter_mut().zip(before).zip(leaving).zip(entering) {
                for k in 0..LANES {
                    out[k] = (sum[k] as f32 + self.end * (before[k] + entering[k])) * self.scale;
                    sum[k] += f64::from(entering[k] - leaving[k]);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spike_becomes_a_bell_of_the_variance_asked_for() {
        for sigma in [0.3f32, 1.0, 2.5, 9.0] {
            let n = 129;
            let mut values = vec![0.0; n * n];
            values[64 * n + 64] = 1.0;
            gaussian(&mut values, n, sigma, Wrap::Repeat);
            let (mut sum, mut variance) = (0.0, 0.0);
            for (k, v) in values.iter().enumerate() {
                let x = (k % n) as f32 - 64.0;
                sum += v;
                variance += v * x * x;
            }
            assert!((sum - 1.0).abs() < 1e-4, "{sigma}: {sum}");
            assert!((variance / (sigma * sigma) - 1.0).abs() < 0.01, "{sigma}: {variance}");
            // The bell itself.
            if sigma > 2.0 {
                let bell = |x: f32| (-0.5 * (x / sigma).powi(2)).exp() / (std::f32::consts::TAU * sigma * sigma);
                for x in 0..(2.0 * sigma) as usize {
                    let got = values[64 * n + 64 + x];
                    assert!((got - bell(x as f32)).abs() < 0.08 * bell(0.0), "{sigma} {x}: {got}");
                }
            }
        }
    }

    #[test]
    fn borders_wrap_or_mirror_and_a_plane_stays_a_plane() {
        let mut plane = vec![0.4; 6 * 5];
        gaussian(&mut plane, 6, 20.0, Wrap::Mirror);
        assert!(plane.iter().all(|v| (v - 0.4).abs() < 1e-6));
        let mut spike = vec![0.0; 64];
        spike[0] = 1.0;
        let mut mirrored = spike.clone();
        gaussian(&mut spike, 8, 1.0, Wrap::Repeat);
        gaussian(&mut mirrored, 8, 1.0, Wrap::Mirror);
        assert!(spike[7] > 0.01 && mirrored[7] < 1e-4, "{} {}", spike[7], mirrored[7]);
    }
}
