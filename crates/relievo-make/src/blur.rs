//! Gaussian blurs of any width in the same time.

use rayon::prelude::*;
use relievo_map::Wrap;

/// Passes of the box: four come within a per cent of the bell.
const PASSES: usize = 4;

/// Blurs `values` (rows of `width`) with a Gaussian of the standard deviation `sigma`, in texels; 0 or less leaves them.
///
/// Four passes of a box with fractional ends (Gwosdek, Grewenig, Bruhn and Weickert, "Theoretical foundations of Gaussian
/// convolution by extended box filtering", 2011): the variance is exact whatever `sigma` is, the time the same.
pub(crate) fn gaussian(values: &mut Vec<f32>, width: usize, sigma: f32, wrap: Wrap) {
    if !(sigma > 0.0) || values.is_empty() {
        return;
    }
    let height = values.len() / width;
    rows(values, width, sigma, wrap);
    let mut turned = transposed(values, width);
    rows(&mut turned, height, sigma, wrap);
    *values = transposed(&turned, height);
}

fn rows(values: &mut [f32], width: usize, sigma: f32, wrap: Wrap) {
    let sigma = f64::from(sigma);
    // A box of 2r + 1 texels with ends of weight `end`, whose variance is a quarter of the whole.
    let variance = sigma * sigma / PASSES as f64;
    let reach = (0.5 * ((12.0 * variance + 1.0).sqrt() - 1.0)).floor();
    let full = reach * (reach + 1.0) * (2.0 * reach + 1.0) / 3.0;
    let end = (variance * (2.0 * reach + 1.0) - full) / (2.0 * ((reach + 1.0).powi(2) - variance));
    let scale = 1.0 / (2.0 * reach + 1.0 + 2.0 * end);
    let reach = (reach as usize).min(1 << 20);
    values.par_chunks_mut(width).for_each_init(
        || (vec![0.0f32; width + 2 * (reach + 1)], vec![0.0f32; width]),
        |(padded, out), row| {
            for _ in 0..PASSES {
                for (k, p) in padded.iter_mut().enumerate() {
                    let i = k as i64 - (reach as i64 + 1);
                    *p = row[if (0..width as i64).contains(&i) {
                        i as usize
                    } else {
                        wrap.index(i as i32, width as u32) as usize
                    }];
                }
                // Sums in f64: a running sum must not drift.
                let mut sum: f64 = padded[1..2 * reach + 2].iter().map(|&x| f64::from(x)).sum();
                for x in 0..width {
                    let (left, right) = (f64::from(padded[x]), f64::from(padded[x + 2 * reach + 2]));
                    out[x] = ((sum + end * (left + right)) * scale) as f32;
                    sum += right - f64::from(padded[x + 1]);
                }
                row.copy_from_slice(out);
            }
        },
    );
}

/// Rows become columns.
pub(crate) fn transposed(values: &[f32], width: usize) -> Vec<f32> {
    let height = values.len() / width;
    let mut turned = vec![0.0; values.len()];
    // A strip of columns at a time: reads and writes both stay in the nearest memory.
    const STRIP: usize = 16;
    turned.par_chunks_mut(STRIP * height).enumerate().for_each(|(strip, out)| {
        let first = strip * STRIP;
        for y in 0..height {
            for (k, row) in out.chunks_exact_mut(height).enumerate() {
                row[y] = values[y * width + first + k];
            }
        }
    });
    turned
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
