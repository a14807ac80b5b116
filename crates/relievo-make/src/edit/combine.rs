//! Combination of two maps of one size.

use rayon::prelude::*;
use relievo_map::Grid;

use super::error::EditError;
use crate::curve::smooth_max;

/// Operator that combines two maps.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Combine {
    /// The maximum.
    Max,
    /// The minimum.
    Min,
    /// The first plus the second times this weight.
    Add(f32),
    /// Smooth maximum: the corner is rounded where the maps differ by less than this (> 0), as a stone sinks into sand.
    Blend(f32),
}

/// Combines two maps of one size, texel by texel.
///
/// # Errors
/// If their sizes differ.
pub fn combine(a: &Grid<f32>, b: &Grid<f32>, mode: Combine) -> Result<Grid<f32>, EditError> {
    let f = move |a: f32, b: f32| match mode {
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

/// Interpolates from `a` (mask 0) to `b` (mask 1).
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

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(w: u32, h: u32) -> Grid<f32> {
        Grid::from_fn(w, h, |x, y| (x + y * w) as f32 / (w * h - 1) as f32)
    }

    #[test]
    fn maps_are_put_together_as_asked_and_must_be_of_one_size() {
        let (a, b) = (Grid::new(2, 1, vec![0.2, 0.8]).unwrap(), Grid::new(2, 1, vec![0.6, 0.4]).unwrap());
        let texels = |mode| combine(&a, &b, mode).unwrap().into_texels();
        assert_eq!(texels(Combine::Max), [0.6, 0.8]);
        assert_eq!(texels(Combine::Min), [0.2, 0.4]);
        assert_eq!(texels(Combine::Add(0.5)), [0.5, 1.0]);
        assert_eq!(texels(Combine::Blend(0.1)), [0.6, 0.8]);
        let mask = Grid::new(2, 1, vec![1.0, 0.0]).unwrap();
        assert_eq!(masked(&a, &b, &mask).unwrap().texels(), [0.6, 0.8]);
        assert!(combine(&a, &ramp(3, 1), Combine::Max).unwrap_err().to_string().contains("2×1 and 3×1"));
    }
}
