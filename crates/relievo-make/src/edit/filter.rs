//! Neighbourhood filters: blur, sharpening, median, debanding.

use rayon::prelude::*;
use relievo_map::{Grid, Wrap};

use super::error::{EditError, MAX_MEDIAN};
use crate::blur::gaussian;

/// Blurs with a Gaussian of the standard deviation `sigma`, in texels.
#[must_use]
pub fn blur(grid: &Grid<f32>, sigma: f32, wrap: Wrap) -> Grid<f32> {
    let mut blurred = grid.clone();
    gaussian(blurred.texels_mut(), grid.width() as usize, sigma, wrap);
    blurred
}

/// Sharpens by an unsharp mask: adds `amount` times the difference from a blur of `sigma` texels.
#[must_use]
pub fn sharpen(grid: &Grid<f32>, sigma: f32, amount: f32, wrap: Wrap) -> Grid<f32> {
    let blurred = blur(grid, sigma, wrap);
    let mut sharp = grid.clone();
    sharp.texels_mut().par_iter_mut().zip(blurred.texels()).for_each(|(v, b)| *v += amount * (*v - b));
    sharp
}

/// Replaces each texel by the median of the square of `2·radius + 1` texels around it: removes specks, keeps edges.
///
/// # Errors
/// If `radius` is over [`MAX_MEDIAN`].
pub fn median(grid: &Grid<f32>, radius: u32, wrap: Wrap) -> Result<Grid<f32>, EditError> {
    if radius > MAX_MEDIAN {
        return Err(EditError::Median { radius });
    }
    let (w, h, r) = (grid.width(), grid.height(), radius as i32);
    let mut out = grid.clone();
    out.texels_mut().par_chunks_mut(w as usize).enumerate().for_each_init(Vec::new, |window, (y, row)| {
        for (x, out) in row.iter_mut().enumerate() {
            window.clear();
            for dy in -r..=r {
                let line = wrap.index(y as i32 + dy, h);
                window.extend((-r..=r).map(|dx| *grid.get(wrap.index(x as i32 + dx, w), line)));
            }
            let middle = window.len() / 2;
            *out = *window.select_nth_unstable_by(middle, f32::total_cmp).1;
        }
    });
    Ok(out)
}

/// Smooths the stair-steps of quantized heights (`steps` is 255 for 8 bits): the result quantizes to the same steps, as
/// no texel moves by more than half a step.
///
/// Blurs from wide to narrow, and clamps every value to its step after each blur.
#[must_use]
pub fn deband(grid: &Grid<f32>, steps: f32, wrap: Wrap) -> Grid<f32> {
    // A hair inside, so that rounding gives the same step again.
    let reach = 0.498 / steps;
    let mut smooth = grid.clone();
    for sigma in [24.0, 12.0, 6.0, 6.0, 3.0, 3.0, 1.5, 1.5, 1.0] {
        smooth = blur(&smooth, sigma, wrap);
        smooth.texels_mut().par_iter_mut().zip(grid.texels()).for_each(|(v, step)| {
            *v = v.max(step - reach).min(step + reach);
        });
    }
    smooth
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_median_takes_specks_and_keeps_edges() {
        let edge = Grid::from_fn(16, 16, |x, _| if x < 8 { 0.0 } else { 1.0 });
        let mut specks = edge.clone();
        specks.texels_mut()[3 * 16 + 3] = 1.0;
        assert_eq!(median(&specks, 1, Wrap::Clamp).unwrap(), edge);
        assert_eq!(median(&specks, 99, Wrap::Clamp), Err(EditError::Median { radius: 99 }));
    }

    #[test]
    fn sharpening_undoes_a_little_of_a_blur() {
        let edge = Grid::from_fn(32, 4, |x, _| if x < 16 { 0.0 } else { 1.0 });
        let soft = blur(&edge, 2.0, Wrap::Clamp);
        let sharp = sharpen(&soft, 2.0, 1.0, Wrap::Clamp);
        let step = |g: &Grid<f32>| g.get(16, 1) - g.get(15, 1);
        assert!(step(&sharp) > 1.2 * step(&soft));
    }

    #[test]
    fn stair_steps_become_smooth_and_stay_the_same_8_bits() {
        let hill = Grid::from_fn(256, 64, |x, y| {
            let (u, v) = (x as f32 / 256.0, y as f32 / 64.0);
            0.5 + 0.06 * (std::f32::consts::TAU * u).sin() * (std::f32::consts::TAU * v).cos()
        });
        let eight_bits = |g: &Grid<f32>| g.map(|&v| (v * 255.0).round() / 255.0);
        let stairs = eight_bits(&hill);
        let smooth = deband(&stairs, 255.0, Wrap::Repeat);
        assert_eq!(eight_bits(&smooth), stairs);
        let off = |g: &Grid<f32>| {
            let slope = |g: &Grid<f32>, x, y| g.get(x + 1, y) - g.get(x, y);
            (0..63)
                .flat_map(|y| (0..255).map(move |x| (x, y)))
                .map(|(x, y)| (slope(g, x, y) - slope(&hill, x, y)).powi(2))
                .sum::<f32>()
        };
        assert!(off(&smooth) < 0.2 * off(&stairs), "{} {}", off(&smooth), off(&stairs));
    }
}
