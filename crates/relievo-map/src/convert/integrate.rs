//! Integration of normals to heights: a Poisson equation, solved by Fourier or cosine transforms.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustdct::{DctPlanner, TransformType2And3};
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use super::derivative::{Border, DerivativeKernel};
use super::strips::Strips;
use crate::types::{Grid, HeightMap, NormalMap};

/// Options of [`normal_to_height`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct IntegrateOptions {
    /// The kernel that the normals were made with. Finite differences underrate the slopes of the finest waves, and
    /// this is undone.
    pub kernel: DerivativeKernel,
    /// Border of the map. A map that does not tile must not be taken as tiling: its heights would bend at the border.
    pub border: Border,
    /// Damping of waves that the kernel hardly responds to and that would amplify rounding errors: 0 for exact normals.
    /// `None` chooses by the steps that the normals were rounded to.
    pub damping: Option<f64>,
}

/// The result of [`normal_to_height`].
#[derive(Clone, Debug, PartialEq)]
pub struct HeightFromNormal {
    /// Heights from 0 to 1; 1 everywhere if the normals are flat.
    pub map: HeightMap,
    /// Full range of the heights as a fraction of one repeat along u.
    pub height_scale: f32,
}

/// Steepest slope of a normal; one that lies in the plane or points inwards has none.
const MAX_SLOPE: f64 = 1000.0;

/// Integrates normals to heights whose slopes, as `options.kernel` measures them, fit those of the normals by least
/// squares (Frankot and Chellappa, "A method for enforcing integrability in shape from shading algorithms", 1988,
/// with the transfer function of the difference kernel in place of the derivative's).
///
/// Tiling maps are sums of waves (FFT). At an open border the field is mirrored, which makes heights sums of cosines
/// (DCT) and slopes sums of sines, with no condition on the border (Neumann). All in f64; peak memory is 7 times that
/// of the result.
#[must_use]
pub fn normal_to_height(map: &NormalMap, options: &IntegrateOptions) -> HeightFromNormal {
    let damping = options.damping.unwrap_or_else(|| damping_for(map)).max(0.0);
    let heights = match options.border {
        Border::Wrap => integrate_tiling(map, options.kernel, damping),
        Border::Open => integrate_open(map, options.kernel, damping),
    };
    let (low, high) = heights.iter().fold((f32::MAX, f32::MIN), |(low, high), &h| (low.min(h), high.max(h)));
    let range = high - low;
    let flat = !(range > 1e-6);
    let width = map.grid().width();
    let map =
        Grid::from_texels(width, map.grid().height(), heights).map(|h| if flat { 1.0 } else { (h - low) / range });
    HeightFromNormal { map: HeightMap::new(map), height_scale: if flat { 0.0 } else { range / width as f32 } }
}

/// Chooses the damping by the rounding of the normals: 8 bits make slopes wrong by a part in 400, 16 bits by a part in
/// 10⁵, f32 by one in 10⁷.
fn damping_for(map: &NormalMap) -> f64 {
    let stepped = |nearest: fn(f32) -> f32, steps: f32| {
        map.grid().texels().iter().flatten().all(|&c| (nearest(c) - c).abs() * steps < 0.02)
    };
    if stepped(|c| NormalMap::decode8(NormalMap::encode8(c)), 127.0) {
        1e-5
    } else if stepped(|c| NormalMap::decode16(NormalMap::encode16(c)), 32767.0) {
        1e-9
    } else {
        1e-10
    }
}

/// Returns the slope of texel (x, y) along u (axis 0) or down along v (axis 1), in texels per texel.
fn slope(map: &NormalMap, x: usize, y: usize, axis: usize) -> f64 {
    let n = map.grid().get(x as u32, y as u32);
    let z = f64::from(n[2]).max(1e-9);
    // Rows run down and y up.
    let sign = if axis == 0 { -1.0 } else { 1.0 };
    (sign * f64::from(n[axis]) / z).clamp(-MAX_SLOPE, MAX_SLOPE)
}

/// Returns the response of both directions' kernels to a wave of `x` and `y` radians per texel, and its damped power.
fn transfer(kernel: DerivativeKernel, x: f64, y: f64, damping: f64) -> ([f64; 2], f64) {
    let response = [x.sin() * kernel.row_response(y), y.sin() * kernel.row_response(x)];
    let laplacian = 4.0 - 2.0 * x.cos() - 2.0 * y.cos();
    (response, response[0] * response[0] + response[1] * response[1] + damping * laplacian * laplacian)
}

/// Least power of a wave that is solved for.
const MIN_POWER: f64 = 1e-18;

/// Fourier coefficient of a wave.
type Wave = Complex<f64>;

/// Integrates a tiling map (FFT).
fn integrate_tiling(map: &NormalMap, kernel: DerivativeKernel, damping: f64) -> Vec<f32> {
    let (w, h) = (map.grid().width() as usize, map.grid().height() as usize);
    let mut planner = RealFftPlanner::<f64>::new();
    let (forward, inverse): (Arc<dyn RealToComplex<f64>>, Arc<dyn ComplexToReal<f64>>) =
        (planner.plan_fft_forward(w), planner.plan_fft_inverse(w));
    let mut complex = FftPlanner::<f64>::new();
    let (down, up) = (complex.plan_fft_forward(h), complex.plan_fft_inverse(h));
    let half = w / 2 + 1;

    let spectrum = |axis: usize| {
        let mut waves = Strips::<Wave>::from_rows(
            half,
            h,
            || (vec![0.0; w], forward.make_scratch_vec()),
            |(row, scratch), y, out| {
                row.iter_mut().enumerate().for_each(|(x, s)| *s = slope(map, x, y, axis));
                // The lengths are right: they come from the plan.
                let _ = forward.process_with_scratch(row, out, scratch);
            },
        );
        waves.each_column(
            || vec![Wave::default(); down.get_inplace_scratch_len()],
            |scratch, _, column| down.process_with_scratch(column, scratch),
        );
        waves
    };
    let mut waves = spectrum(0);
    let spectrum_v = spectrum(1);
    let scale = 1.0 / (w * h) as f64;
    waves.combine(&spectrum_v, |k, l, p, q| {
        let (x, y) = (TAU * k as f64 / w as f64, TAU * l as f64 / h as f64);
        let ([sx, sy], weight) = transfer(kernel, x, y, damping);
        if weight > MIN_POWER { Wave::new(0.0, -scale) * (p * sx + q * sy) / weight } else { Wave::default() }
    });
    drop(spectrum_v);
    waves.each_column(
        || vec![Wave::default(); up.get_inplace_scratch_len()],
        |scratch, _, column| up.process_with_scratch(column, scratch),
    );
    waves.into_rows(
        w,
        || (vec![0.0; w], inverse.make_scratch_vec()),
        |(row, scratch), waves, out| {
            // Real but for rounding.
            waves[0].im = 0.0;
            if w % 2 == 0 {
                waves[half - 1].im = 0.0;
            }
            let _ = inverse.process_with_scratch(waves, row, scratch);
            out.iter_mut().zip(row).for_each(|(o, h)| *o = *h as f32);
        },
    )
}

/// Integrates a map with an open border (DCT).
fn integrate_open(map: &NormalMap, kernel: DerivativeKernel, damping: f64) -> Vec<f32> {
    let (w, h) = (map.grid().width() as usize, map.grid().height() as usize);
    let mut planner = DctPlanner::<f64>::new();
    let (row_plan, column_plan) = (planner.plan_dct2(w), planner.plan_dct2(h));
    let scratch = |plan: &Arc<dyn TransformType2And3<f64>>| vec![0.0; plan.get_scratch_len()];

    // Slopes along u are sums of sines along u and of cosines along v, and the other way round.
    let spectrum = |axis: usize| {
        let mut waves = Strips::<f64>::from_rows(
            w,
            h,
            || scratch(&row_plan),
            |scratch, y, out| {
                for (x, s) in out.iter_mut().enumerate() {
                    // One-sided slopes at the border are twice those of the mirrored field.
                    let (at, last) = if axis == 0 { (x, w - 1) } else { (y, h - 1) };
                    let part = if at == 0 || at == last { 0.5 } else { 1.0 };
                    *s = part * slope(map, x, y, axis);
                }
                if axis == 0 {
                    row_plan.process_dst2_with_scratch(out, scratch);
                    // The wave k stands at k − 1; one has no sine, and the last no cosine.
                    out.rotate_right(1);
                    out[0] = 0.0;
                } else {
                    row_plan.process_dct2_with_scratch(out, scratch);
                }
            },
        );
        waves.each_column(
            || scratch(&column_plan),
            |scratch, _, column| {
                if axis == 0 {
                    column_plan.process_dct2_with_scratch(column, scratch);
                } else {
                    column_plan.process_dst2_with_scratch(column, scratch);
                    column.rotate_right(1);
                    column[0] = 0.0;
                }
            },
        );
        waves
    };
    let mut waves = spectrum(0);
    let spectrum_v = spectrum(1);
    let scale = 4.0 / (w * h) as f64;
    waves.combine(&spectrum_v, |k, l, p, q| {
        let ([sx, sy], weight) = transfer(kernel, PI * k as f64 / w as f64, PI * l as f64 / h as f64, damping);
        if weight > MIN_POWER { -scale * (p * sx + q * sy) / weight } else { 0.0 }
    });
    drop(spectrum_v);
    waves.each_column(
        || scratch(&column_plan),
        |scratch, _, column| column_plan.process_dct3_with_scratch(column, scratch),
    );
    waves.into_rows(
        w,
        || scratch(&row_plan),
        |scratch, waves, out| {
            row_plan.process_dct3_with_scratch(waves, scratch);
            out.iter_mut().zip(waves).for_each(|(o, h)| *o = *h as f32);
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::convert::slopes::height_to_normal;

    /// Hills that tile, of many waves, from an integer hash.
    fn hills(w: u32, h: u32) -> HeightMap {
        let wave = |k: u32| {
            let r = k.wrapping_mul(0x9e37_79b9) ^ 0x5bd1;
            let r = (r ^ (r >> 15)).wrapping_mul(0x85eb_ca6b);
            let part = |s: u32, n: u32| f64::from((r >> s) % n);
            (part(3, 12), part(11, 12), part(17, 1000) * TAU / 1000.0)
        };
        HeightMap::new(Grid::from_fn(w, h, |x, y| {
            let (u, v) = ((f64::from(x) + 0.5) / f64::from(w), (f64::from(y) + 0.5) / f64::from(h));
            let sum: f64 = (1..24)
                .map(|k| {
                    let (a, b, phase) = wave(k);
                    (TAU * (a * u + b * v) + phase).sin() / (1.0 + a + b)
                })
                .sum();
            (0.5 + 0.16 * sum) as f32
        }))
    }

    fn rms(a: &NormalMap, b: &NormalMap) -> f64 {
        let off = |(a, b): (&[f32; 3], &[f32; 3])| (0..3).map(|k| f64::from(a[k] - b[k]).powi(2)).sum::<f64>() / 3.0;
        (a.grid().texels().iter().zip(b.grid().texels()).map(off).sum::<f64>() / a.grid().texels().len() as f64).sqrt()
    }

    /// Normals to heights and back, with everything rounded to files of so many bits in between.
    fn round_trip(normals: &NormalMap, kernel: DerivativeKernel, border: Border) -> f64 {
        let options = IntegrateOptions { kernel, border, damping: None };
        let made = normal_to_height(normals, &options);
        let stored = HeightMap::new(made.map.grid().map(|&h| crate::types::dequantize16(crate::types::quantize16(h))));
        rms(normals, &height_to_normal(&stored, made.height_scale, kernel, border))
    }

    #[test]
    fn normals_come_back_within_their_rounding() {
        for (w, h) in [(96, 64), (81, 55)] {
            for (_, kernel) in DerivativeKernel::ALL {
                for border in [Border::Wrap, Border::Open] {
                    let exact = height_to_normal(&hills(w, h), 0.1, kernel, border);
                    let rounded8 =
                        NormalMap::new(exact.grid().map(|n| n.map(|c| NormalMap::decode8(NormalMap::encode8(c)))));
                    let rounded16 =
                        NormalMap::new(exact.grid().map(|n| n.map(|c| NormalMap::decode16(NormalMap::encode16(c)))));
                    // The range of a component is 2; half of what was asked for is held here as well.
                    let (off8, off16) = (round_trip(&rounded8, kernel, border), round_trip(&rounded16, kernel, border));
                    assert!(off8 / 2.0 <= 0.0015, "{w}×{h} {kernel:?} {border:?}: {off8}");
                    assert!(off16 / 2.0 <= 0.0003, "{w}×{h} {kernel:?} {border:?}: {off16}");
                }
            }
        }
    }

    #[test]
    fn heights_come_back_exactly_but_for_what_no_slope_shows() {
        for (w, h) in [(96, 64), (81, 55)] {
            for border in [Border::Wrap, Border::Open] {
                let hills = hills(w, h);
                let made = normal_to_height(
                    &height_to_normal(&hills, 0.1, DerivativeKernel::Central, border),
                    &IntegrateOptions { border, ..IntegrateOptions::default() },
                );
                let (low, high) =
                    hills.grid().texels().iter().fold((1.0f32, 0.0f32), |(l, h), &x| (l.min(x), h.max(x)));
                assert!((made.height_scale / (0.1 * (high - low)) - 1.0).abs() < 1e-4, "{border:?}");
                for (a, b) in made.map.grid().texels().iter().zip(hills.grid().texels()) {
                    assert!((a - (b - low) / (high - low)).abs() < 1e-4, "{w}×{h} {border:?}");
                }
            }
        }
    }

    #[test]
    fn a_ramp_that_does_not_tile_comes_back_to_a_millionth() {
        for (w, h) in [(64, 64), (200, 90), (257, 63)] {
            let ramp = Grid::from_fn(w, h, |x, y| (0.7 * x as f32 / (w - 1) as f32) + 0.3 * y as f32 / (h - 1) as f32);
            for (_, kernel) in DerivativeKernel::ALL {
                let normals = height_to_normal(&HeightMap::new(ramp.clone()), 0.2, kernel, Border::Open);
                let options = IntegrateOptions { kernel, border: Border::Open, damping: None };
                let made = normal_to_height(&normals, &options);
                let worst =
                    made.map.grid().texels().iter().zip(ramp.texels()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
                assert!(worst <= 1e-6, "{w}×{h} {kernel:?}: {worst}");
            }
        }
    }

    #[test]
    fn a_ramp_taken_as_tiling_would_be_bent() {
        let ramp = HeightMap::new(Grid::from_fn(64, 64, |x, _| x as f32 / 63.0));
        let normals = height_to_normal(&ramp, 0.2, DerivativeKernel::Central, Border::Open);
        let made = normal_to_height(&normals, &IntegrateOptions::default());
        assert!(made.height_scale < 0.01);
    }

    #[test]
    fn flat_tiny_and_impossible_normals_give_heights_all_the_same() {
        for border in [Border::Wrap, Border::Open] {
            let options = IntegrateOptions { border, ..IntegrateOptions::default() };
            for (w, h) in [(1, 1), (2, 1), (1, 5), (3, 2)] {
                for n in [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.3, -0.4, -0.8]] {
                    let made = normal_to_height(&NormalMap::new(Grid::filled(w, h, n)), &options);
                    assert!(
                        made.map.grid().texels().iter().all(|h| (0.0..=1.0).contains(h))
                            && made.height_scale.is_finite()
                    );
                }
            }
            let flat = normal_to_height(&NormalMap::new(Grid::filled(8, 8, [0.0, 0.0, 1.0])), &options);
            assert_eq!((flat.height_scale, flat.map.grid().texels()[0]), (0.0, 1.0));
        }
    }

    #[test]
    fn threads_do_not_change_a_bit() {
        let normals = height_to_normal(&hills(70, 50), 0.1, DerivativeKernel::Sobel, Border::Open);
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                [Border::Wrap, Border::Open].map(|border| {
                    normal_to_height(&normals, &IntegrateOptions { border, ..IntegrateOptions::default() })
                })
            })
        };
        assert_eq!(on(1), on(5));
    }
}
