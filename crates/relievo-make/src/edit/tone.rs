//! Edits of each texel by itself: levels, curves, inversion.

use rayon::prelude::*;
use relievo_map::Grid;

use super::error::EditError;

fn changed(grid: &Grid<f32>, f: impl Fn(f32) -> f32 + Sync) -> Grid<f32> {
    let mut grid = grid.clone();
    grid.texels_mut().par_iter_mut().for_each(|v| *v = f(*v));
    grid
}

/// Maps `low` to 0 and `high` to 1, clamps, then raises to the power 1 / `gamma` (> 1 lightens). `low > high` inverts.
#[must_use]
pub fn levels(grid: &Grid<f32>, low: f32, high: f32, gamma: f32) -> Grid<f32> {
    let span = if high == low { 1e-9 } else { high - low };
    let power = 1.0 / gamma.max(1e-3);
    changed(grid, |v| ((v - low) / span).max(0.0).min(1.0).powf(power))
}

/// Applies a curve through `points` (from, to), monotone between them where they are (Fritsch and Carlson, "Monotone
/// piecewise cubic interpolation", 1980), constant beyond.
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

/// Inverts each value: 1 − v.
#[must_use]
pub fn invert(grid: &Grid<f32>) -> Grid<f32> {
    changed(grid, |v| 1.0 - v)
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
