//! Resampling to another size.

use rayon::prelude::*;
use relievo_map::{Grid, GridError, Wrap};

use super::error::EditError;

/// Resamples a map to another size with Catmull-Rom splines (1974), widened to the new texels where the map shrinks. A
/// tiling map still tiles.
///
/// # Errors
/// If a side is 0 or over [`Grid::MAX_SIDE`].
pub fn resize(grid: &Grid<f32>, width: u32, height: u32, wrap: Wrap) -> Result<Grid<f32>, EditError> {
    if width == 0 || height == 0 || width.max(height) > Grid::<f32>::MAX_SIDE {
        return Err(GridError::Size { width, height }.into());
    }
    Ok(resized(grid, width, height, wrap))
}

/// [`resize`] to a valid size.
pub(crate) fn resized(grid: &Grid<f32>, width: u32, height: u32, wrap: Wrap) -> Grid<f32> {
    if (width, height) == (grid.width(), grid.height()) {
        return grid.clone();
    }
    let mut out = Grid::filled(width, height, 0.0);
    add_resized(&mut out, grid, 1.0, wrap);
    out
}

/// Adds `weight` times `grid`, resampled to the size of `out`.
pub(crate) fn add_resized(out: &mut Grid<f32>, grid: &Grid<f32>, weight: f32, wrap: Wrap) {
    let (from, to) = (grid.width(), out.width());
    let across = rows(grid.texels(), from, to, wrap);
    let (from, height) = (grid.height(), out.height());
    let width = to as usize;
    out.texels_mut().par_chunks_mut(width).enumerate().for_each(|(y, out)| {
        for (line, share) in taps(y as u32, from, height, wrap) {
            let (start, share) = (line as usize * width, share * weight);
            out.iter_mut().zip(&across[start..start + width]).for_each(|(out, value)| *out += share * value);
        }
    });
}

/// Resamples rows of `from` texels to rows of `to`.
fn rows(values: &[f32], from: u32, to: u32, wrap: Wrap) -> Vec<f32> {
    let taps: Vec<Vec<(u32, f32)>> = (0..to).map(|x| taps(x, from, to, wrap)).collect();
    let count = values.len() / from as usize;
    let mut out = vec![0.0; count * to as usize];
    out.par_chunks_mut(to as usize).zip(values.par_chunks(from as usize)).for_each(|(out, row)| {
        for (out, taps) in out.iter_mut().zip(&taps) {
            *out = taps.iter().map(|&(x, weight)| weight * row[x as usize]).sum();
        }
    });
    out
}

/// Returns the source texels of a new one, with their weights.
fn taps(x: u32, from: u32, to: u32, wrap: Wrap) -> Vec<(u32, f32)> {
    let ratio = f64::from(from) / f64::from(to);
    let wide = ratio.max(1.0);
    let middle = (f64::from(x) + 0.5) * ratio - 0.5;
    let first = (middle - 2.0 * wide).ceil() as i32;
    let last = (middle + 2.0 * wide).floor() as i32;
    let weights: Vec<f64> = (first..=last).map(|i| catmull_rom((f64::from(i) - middle) / wide)).collect();
    let sum: f64 = weights.iter().sum();
    (first..=last).zip(weights).map(|(i, weight)| (wrap.index(i, from), (weight / sum) as f32)).collect()
}

fn catmull_rom(t: f64) -> f64 {
    let t = t.abs();
    if t < 1.0 {
        1.0 - 2.5 * t * t + 1.5 * t * t * t
    } else if t < 2.0 {
        2.0 - 4.0 * t + 2.5 * t * t - 0.5 * t * t * t
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f32::consts::TAU;

    fn wave(w: u32, h: u32) -> Grid<f32> {
        Grid::from_fn(w, h, |x, y| {
            let (u, v) = ((x as f32 + 0.5) / w as f32, (y as f32 + 0.5) / h as f32);
            0.5 + 0.25 * (TAU * 2.0 * u).sin() + 0.2 * (TAU * 3.0 * v).cos()
        })
    }

    #[test]
    fn a_wave_is_the_same_wave_at_any_size_across_the_seam_too() {
        for (w, h) in [(128, 96), (50, 40), (64, 64), (301, 33)] {
            let resized = resize(&wave(64, 64), w, h, Wrap::Repeat).unwrap();
            for (a, b) in resized.texels().iter().zip(wave(w, h).texels()) {
                assert!((a - b).abs() < 0.01, "{w}×{h}: {a} for {b}");
            }
        }
    }

    #[test]
    fn the_same_size_changes_nothing_and_impossible_sizes_are_refused() {
        let grid = wave(20, 10);
        assert_eq!(resize(&grid, 20, 10, Wrap::Clamp).unwrap(), grid);
        assert!(resize(&grid, 0, 10, Wrap::Clamp).is_err() && resize(&grid, 1 << 20, 1, Wrap::Clamp).is_err());
        let plain = resize(&Grid::filled(1, 1, 0.4), 3, 2, Wrap::Mirror).unwrap();
        assert!(plain.texels().iter().all(|v| (v - 0.4).abs() < 1e-6));
    }
}
