//! Image processing for maps: what keeps a tiling map tiling, and heights in their range.
//!
//! Everything works on one number per texel; colours are edited channel by channel. Lengths are in texels. Beyond the border
//! lies what [`Wrap`] says: `Repeat` for maps that tile.

mod resize;
mod turn;

use rayon::prelude::*;
use relievo_map::{Grid, GridError, Wrap};
use thiserror::Error;

use crate::blur::gaussian;
use crate::curve::smooth_max;
pub use resize::resize;
pub(crate) use resize::{add_resized, resized};
pub use turn::{Turn, turned, turned_normals};

/// Why an edit could not be done.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum EditError {
    /// Two maps that are put together have different sizes.
    #[error(
        "maps of {}×{} and {}×{} texels cannot be put together; resize one of them first",
        a[0], a[1], b[0], b[1]
    )]
    Size {
        /// Width and height of the first.
        a: [u32; 2],
        /// Width and height of the second.
        b: [u32; 2],
    },
    /// The points of a curve do not rise.
    #[error("a curve needs at least two points whose first numbers rise")]
    Curve,
    /// The radius of a median is too large.
    #[error("the radius of a median is at most {max} texels, not {radius}", max = MAX_MEDIAN)]
    Median {
        /// The radius asked for.
        radius: u32,
    },
    /// A map cannot have this size.
    #[error(transparent)]
    Grid(#[from] GridError),
}

/// The largest radius of [`median`].
pub const MAX_MEDIAN: u32 = 16;

fn changed(grid: &Grid<f32>, f: impl Fn(f32) -> f32 + Sync) -> Grid<f32> {
    let mut grid = grid.clone();
    grid.texels_mut().par_iter_mut().for_each(|v| *v = f(*v));
    grid
}

/// `low` becomes 0, `high` 1, what is beyond is clamped; then the power 1 / `gamma` (> 1 lightens). `low > high` inverts.
#[must_use]
pub fn levels(grid: &Grid<f32>, low: f32, high: f32, gamma: f32) -> Grid<f32> {
    let span = if high == low { 1e-9 } else { high - low };
    let power = 1.0 / gamma.max(1e-3);
    changed(grid, |v| ((v - low) / span).max(0.0).min(1.0).powf(power))
}

/// A curve through `points` (from, to), monotone between them where they are (Fritsch and Carlson, "Monotone piecewise
/// cubic interpolation", 1980), constant beyond.
///
/// # Errors
/// If there are fewer than two points, or their first numbers do not rise.
pub fn curve(grid: &Grid<f32>, points: &[[f32; 2]]) -> Result<Grid<f32>, EditError> {
    if points.len() < 2
        || !points.windows(2).all(|p| p[0][0] < p[1][0])
        || !points.iter().flatten().all(|x| x.is_finite())
    {
        return Err(EditError::Curve);
    }
    let slopes: Vec<f32> = points.windows(2).map(|p| (p[1][1] - p[0][1]) / (p[1][0] - p[0][0])).collect();
    let tangent = |k: usize| match (k.checked_sub(1).map(|k| slopes[k]), slopes.get(k)) {
        (Some(a), Some(&b)) if a * b > 0.0 => 2.0 * a * b / (a + b),
        (Some(_), Some(_)) => 0.0,
        (Some(a), None) => a,
        (None, b) => b.copied().unwrap_or(0.0),
    };
    let tangents: Vec<f32> = (0..points.len()).map(tangent).collect();
    Ok(changed(grid, |v| {
        let k = points.partition_point(|p| p[0] <= v);
        if k == 0 {
            return points[0][1];
        }
        let (Some(b), a) = (points.get(k), points[k - 1]) else { return points[points.len() - 1][1] };
        let width = b[0] - a[0];
        let t = (v - a[0]) / width;
        let (t2, t3) = (t * t, t * t * t);
        (2.0 * t3 - 3.0 * t2 + 1.0) * a[1]
            + (t3 - 2.0 * t2 + t) * width * tangents[k - 1]
            + (3.0 * t2 - 2.0 * t3) * b[1]
            + (t3 - t2) * width * tangents[k]
    }))
}

/// 1 − v.
#[must_use]
pub fn invert(grid: &Grid<f32>) -> Grid<f32> {
    changed(grid, |v| 1.0 - v)
}

/// A Gaussian blur of the standard deviation `sigma`, in texels.
#[must_use]
pub fn blur(grid: &Grid<f32>, sigma: f32, wrap: Wrap) -> Grid<f32> {
    let mut blurred = grid.clone();
    gaussian(blurred.texels_mut(), grid.width() as usize, sigma, wrap);
    blurred
}

/// Unsharp mask: `amount` times what a blur of `sigma` texels takes away is added.
#[must_use]
pub fn sharpen(grid: &Grid<f32>, sigma: f32, amount: f32, wrap: Wrap) -> Grid<f32> {
    let blurred = blur(grid, sigma, wrap);
    let mut sharp = grid.clone();
    sharp.texels_mut().par_iter_mut().zip(blurred.texels()).for_each(|(v, b)| *v += amount * (*v - b));
    sharp
}

/// The median of the square of `2·radius + 1` texels around each: specks go, edges stay.
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

/// How two maps become one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Combine {
    /// The higher one.
    Max,
    /// The lower one.
    Min,
    /// The first and so much of the second.
    Add(f32),
    /// The higher one, with the corner rounded off where they differ by less than this (> 0): a stone that sinks into sand.
    Blend(f32),
}

/// Puts two maps of one size together.
///
/// # Errors
/// If their sizes differ.
pub fn combine(a: &Grid<f32>, b: &Grid<f32>, how: Combine) -> Result<Grid<f32>, EditError> {
    let f = move |a: f32, b: f32| match how {
        Combine::Max => a.max(b),
        Combine::Min => a.min(b),
        Combine::Add(weight) => a + weight * b,
        Combine::Blend(softness) => smooth_max(a, b, softness.max(1e-6)),
    };
    check(a, b)?;
    let mut out = a.clone();
    out.texels_mut().par_iter_mut().zip(b.texels()).for_each(|(a, b)| *a = f(*a, *b));
    Ok(out)
}

/// `a` where `mask` is 0, `b` where it is 1.
///
/// # Errors
/// If their sizes differ.
pub fn masked(a: &Grid<f32>, b: &Grid<f32>, mask: &Grid<f32>) -> Result<Grid<f32>, EditError> {
    check(a, b)?;
    check(a, mask)?;
    let mut out = a.clone();
    let pairs = b.texels().par_iter().zip(mask.texels());
    out.texels_mut().par_iter_mut().zip(pairs).for_each(|(a, (b, m))| *a += (b - *a) * m);
    Ok(out)
}

fn check(a: &Grid<f32>, b: &Grid<f32>) -> Result<(), EditError> {
    let size = |g: &Grid<f32>| [g.width(), g.height()];
    if size(a) == size(b) { Ok(()) } else { Err(EditError::Size { a: size(a), b: size(b) }) }
}

/// Stair-steps of `steps` values (255 for 8 bits) made smooth: the smoothest surface that would be rounded to the same
/// steps. No texel moves by more than half a step.
///
/// Blurs from wide to narrow, and after each puts every value back between the borders of its step.
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

    fn ramp(w: u32, h: u32) -> Grid<f32> {
        Grid::from_fn(w, h, |x, y| (x + y * w) as f32 / (w * h - 1) as f32)
    }

    #[test]
    fn levels_and_curves_do_what_they_say() {
        let grid = Grid::new(5, 1, vec![0.0, 0.25, 0.5, 0.75, 1.0]).unwrap();
        assert_eq!(levels(&grid, 0.25, 0.75, 1.0).texels(), [0.0, 0.0, 0.5, 1.0, 1.0]);
        assert!((levels(&grid, 0.0, 1.0, 2.0).texels()[1] - 0.5).abs() < 1e-6);
        assert_eq!(levels(&grid, 1.0, 0.0, 1.0).texels(), invert(&grid).texels());
        let bent = curve(&grid, &[[0.0, 0.1], [0.5, 0.8], [1.0, 0.9]]).unwrap();
        assert!((bent.texels()[0] - 0.1).abs() < 1e-6 && (bent.texels()[2] - 0.8).abs() < 1e-6);
        assert!(bent.texels().windows(2).all(|p| p[0] < p[1]), "{:?}", bent.texels());
        assert_eq!(curve(&grid, &[[0.5, 0.0], [0.5, 1.0]]), Err(EditError::Curve));
        assert_eq!(curve(&grid, &[]), Err(EditError::Curve));
    }

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
    fn maps_are_put_together_as_asked_and_must_be_of_one_size() {
        let (a, b) = (Grid::new(2, 1, vec![0.2, 0.8]).unwrap(), Grid::new(2, 1, vec![0.6, 0.4]).unwrap());
        let texels = |how| combine(&a, &b, how).unwrap().into_texels();
        assert_eq!(texels(Combine::Max), [0.6, 0.8]);
        assert_eq!(texels(Combine::Min), [0.2, 0.4]);
        assert_eq!(texels(Combine::Add(0.5)), [0.5, 1.0]);
        assert_eq!(texels(Combine::Blend(0.1)), [0.6, 0.8]);
        let mask = Grid::new(2, 1, vec![1.0, 0.0]).unwrap();
        assert_eq!(masked(&a, &b, &mask).unwrap().texels(), [0.6, 0.8]);
        assert!(combine(&a, &ramp(3, 1), Combine::Max).unwrap_err().to_string().contains("2×1 and 3×1"));
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
