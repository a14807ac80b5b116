use std::f64::consts::TAU;

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use super::strips::Strips;
use crate::types::Grid;

/// Makes a grid tile: the jumps between opposite borders are spread over all of it as a smooth field, whose Laplacian
/// is 0 inside (Moisan, "Periodic plus smooth image decomposition", 2011). Detail stays as it is; the mean too.
#[must_use]
pub fn periodic(grid: &Grid<f32>) -> Grid<f32> {
    let (w, h) = (grid.width() as usize, grid.height() as usize);
    let mut planner = FftPlanner::<f64>::new();
    let plans = [
        planner.plan_fft_forward(w),
        planner.plan_fft_forward(h),
        planner.plan_fft_inverse(h),
        planner.plan_fft_inverse(w),
    ];
    let [across, down, up, back] = plans;
    let texel = |x: usize, y: usize| f64::from(*grid.get(x as u32, y as u32));
    let scratch = |length: usize| move || vec![Complex::<f64>::default(); length];

    let mut waves =
        Strips::<Complex<f64>>::from_rows(w, h, scratch(across.get_inplace_scratch_len()), |scratch, y, out| {
            out.fill(Complex::default());
            // The Laplacian across the seam: what the border lacks, and with the other sign what faces it.
            if w > 1 {
                let jump = texel(w - 1, y) - texel(0, y);
                out[0].re += jump;
                out[w - 1].re -= jump;
            }
            if h > 1 && (y == 0 || y == h - 1) {
                for (x, o) in out.iter_mut().enumerate() {
                    o.re += texel(x, h - 1 - y) - texel(x, y);
                }
            }
            across.process_with_scratch(out, scratch);
        });
    let scale = 1.0 / (w * h) as f64;
    waves.each_column(
        scratch(down.get_inplace_scratch_len().max(up.get_inplace_scratch_len())),
        |scratch, x, column| {
            down.process_with_scratch(column, scratch);
            for (y, wave) in column.iter_mut().enumerate() {
                let laplacian = 2.0 * (TAU * x as f64 / w as f64).cos() + 2.0 * (TAU * y as f64 / h as f64).cos() - 4.0;
                *wave = if x == 0 && y == 0 { Complex::default() } else { *wave * (scale / laplacian) };
            }
            up.process_with_scratch(column, scratch);
        },
    );
    let smooth = waves.into_rows(w, scratch(back.get_inplace_scratch_len()), |scratch, row, out| {
        back.process_with_scratch(row, scratch);
        out.iter_mut().zip(row).for_each(|(o, s)| *o = s.re as f32);
    });
    let texels = grid.texels().iter().zip(smooth).map(|(u, s)| u - s).collect();
    Grid::from_texels(grid.width(), grid.height(), texels)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seam(grid: &Grid<f32>) -> f32 {
        let (w, h) = (grid.width(), grid.height());
        let across: f32 = (0..h).map(|y| (grid.get(0, y) - grid.get(w - 1, y)).abs()).sum::<f32>() / h as f32;
        let down: f32 = (0..w).map(|x| (grid.get(x, 0) - grid.get(x, h - 1)).abs()).sum::<f32>() / w as f32;
        across.max(down)
    }

    #[test]
    fn a_ramp_becomes_flat_and_a_wave_on_it_stays() {
        let wave = |x: u32, y: u32| 0.1 * (TAU * (3.0 * f64::from(x) / 60.0 + 2.0 * f64::from(y) / 44.0)).sin() as f32;
        let grid = Grid::from_fn(60, 44, |x, y| wave(x, y) + 0.5 * x as f32 / 59.0 + 0.3 * y as f32 / 43.0);
        let tiled = periodic(&grid);
        assert!(seam(&grid) > 0.29 && seam(&tiled) < 0.06, "{} {}", seam(&grid), seam(&tiled));
        let mean = |g: &Grid<f32>| g.texels().iter().sum::<f32>() / g.texels().len() as f32;
        assert!((mean(&grid) - mean(&tiled)).abs() < 1e-5);
        for (x, y) in [(20, 20), (30, 10), (41, 33)] {
            let bend = |g: &Grid<f32>| {
                4.0 * g.get(x, y) - g.get(x - 1, y) - g.get(x + 1, y) - g.get(x, y - 1) - g.get(x, y + 1)
            };
            assert!((bend(&grid) - bend(&tiled)).abs() < 1e-4);
        }
    }

    #[test]
    fn what_tiles_already_hardly_changes_and_a_single_texel_stays() {
        let grid = Grid::from_fn(64, 64, |x, _| (TAU * f64::from(x) / 64.0).sin() as f32);
        let tiled = periodic(&grid);
        assert!(grid.texels().iter().zip(tiled.texels()).all(|(a, b)| (a - b).abs() < 0.06));
        let one = Grid::filled(1, 1, 0.7);
        assert_eq!(periodic(&one), one);
    }
}
