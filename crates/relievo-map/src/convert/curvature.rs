use rayon::prelude::*;

use super::derivative::Border;
use crate::types::{Grid, HeightMap, ScalarMap};

/// Computes the mean curvature of the surface: ½ flat, towards 1 edges and tops, towards 0 grooves and hollows.
///
/// `height_scale` is the full range as a fraction of one repeat along u; a ridge that is round with `radius` (in the
/// same unit, > 0) or sharper is 1, a groove 0. From first and second central differences.
#[must_use]
pub fn curvature(map: &HeightMap, height_scale: f32, radius: f32, border: Border) -> ScalarMap {
    let grid = map.grid();
    let (w, h) = (grid.width() as usize, grid.height() as usize);
    let texels = grid.texels();
    // Heights in texels.
    let unit = height_scale * w as f32;
    let index = |i: i64, n: usize| match border {
        Border::Wrap => i.rem_euclid(n as i64) as usize,
        Border::Open => i.clamp(0, n as i64 - 1) as usize,
    };
    let mut out = vec![0.0f32; w * h];
    out.par_chunks_mut(w).enumerate().for_each(|(y, out)| {
        let row = |dy: i64| &texels[index(y as i64 + dy, h) * w..][..w];
        let rows = [row(-1), row(0), row(1)];
        for (x, out) in out.iter_mut().enumerate() {
            let [l, c, r] = [-1, 0, 1].map(|dx| index(x as i64 + dx, w));
            let at = |row: usize, column: usize| unit * rows[row][column];
            let (p, q) = (0.5 * (at(1, r) - at(1, l)), 0.5 * (at(2, c) - at(0, c)));
            let (xx, yy) = (at(1, r) - 2.0 * at(1, c) + at(1, l), at(2, c) - 2.0 * at(1, c) + at(0, c));
            let xy = 0.25 * (at(2, r) - at(2, l) - at(0, r) + at(0, l));
            let numerator = (1.0 + q * q) * xx - 2.0 * p * q * xy + (1.0 + p * p) * yy;
            let mean = -numerator / (2.0 * (1.0 + p * p + q * q).powf(1.5));
            // A ridge bends in one direction only: its mean curvature is half of 1 / radius.
            *out = 0.5 + mean * w as f32 * radius.max(0.0);
        }
    });
    ScalarMap::new(Grid::from_texels(grid.width(), grid.height(), out))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cylinder_is_as_bent_as_its_radius_says_and_a_groove_the_other_way() {
        // A cylinder of radius 0.25 along v, at true scale.
        let cylinder = |x: u32| {
            let d = (x as f32 + 0.5) / 256.0 - 0.5;
            (0.25f32 * 0.25 - d * d).max(0.0).sqrt()
        };
        let map = HeightMap::new(Grid::from_fn(256, 5, |x, _| 0.5 + cylinder(x)));
        let got = |map: &HeightMap, radius| *curvature(map, 1.0, radius, Border::Open).grid().get(128, 2);
        // Half as sharp as what would be white.
        assert!((got(&map, 0.125) - 0.75).abs() < 0.01, "{}", got(&map, 0.125));
        let groove = HeightMap::new(map.grid().map(|h| 1.0 - h));
        assert!((got(&groove, 0.125) - 0.25).abs() < 0.01);
        assert_eq!(*curvature(&map, 1.0, 0.1, Border::Wrap).grid().get(3, 1), 0.5);
    }
}
