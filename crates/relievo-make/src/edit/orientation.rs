//! Rotation by quarters and flips, of any texels and of normals.

use relievo_map::{Grid, NormalMap};

/// Rotation by a multiple of 90°, or a flip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Orientation {
    /// 90° clockwise.
    Rotate90,
    /// 180°.
    Rotate180,
    /// 270° clockwise.
    Rotate270,
    /// Left and right exchanged.
    FlipX,
    /// Top and bottom exchanged.
    FlipY,
}

impl Orientation {
    /// All orientations and their names.
    pub const ALL: [(&'static str, Self); 5] = [
        ("90", Self::Rotate90),
        ("180", Self::Rotate180),
        ("270", Self::Rotate270),
        ("x", Self::FlipX),
        ("y", Self::FlipY),
    ];
}

/// Rotates or flips a map, whatever its texels are; vectors in them stay as they are.
#[must_use]
pub fn reoriented<T: Clone>(grid: &Grid<T>, orientation: Orientation) -> Grid<T> {
    let (w, h) = (grid.width(), grid.height());
    match orientation {
        Orientation::Rotate90 => Grid::from_fn(h, w, |x, y| grid.get(y, h - 1 - x).clone()),
        Orientation::Rotate180 => Grid::from_fn(w, h, |x, y| grid.get(w - 1 - x, h - 1 - y).clone()),
        Orientation::Rotate270 => Grid::from_fn(h, w, |x, y| grid.get(w - 1 - y, x).clone()),
        Orientation::FlipX => Grid::from_fn(w, h, |x, y| grid.get(w - 1 - x, y).clone()),
        Orientation::FlipY => Grid::from_fn(w, h, |x, y| grid.get(x, h - 1 - y).clone()),
    }
}

/// Rotates or flips normals with their map: the result is the normals of the reoriented heights.
#[must_use]
pub fn reoriented_normals(map: &NormalMap, orientation: Orientation) -> NormalMap {
    // In the picture, +Y up.
    let vector = |&[x, y, z]: &[f32; 3]| match orientation {
        Orientation::Rotate90 => [y, -x, z],
        Orientation::Rotate180 => [-x, -y, z],
        Orientation::Rotate270 => [-y, x, z],
        Orientation::FlipX => [-x, y, z],
        Orientation::FlipY => [x, -y, z],
    };
    NormalMap::new(reoriented(&map.grid().map(vector), orientation))
}

#[cfg(test)]
mod tests {
    use super::*;
    use relievo_map::{Border, DerivativeKernel, HeightMap, height_to_normal};

    #[test]
    fn reoriented_normals_are_those_of_the_reoriented_heights() {
        let heights = Grid::from_fn(24, 24, |x, y| {
            let (u, v) = (x as f32 / 24.0 - 0.4, y as f32 / 24.0 - 0.6);
            (1.0 - 3.0 * u * u - 2.0 * v * v + 0.5 * u * v).max(0.0)
        });
        let normals = |g: Grid<f32>| height_to_normal(&HeightMap::new(g), 0.2, DerivativeKernel::Central, Border::Open);
        for (name, orientation) in Orientation::ALL {
            let (a, b) = (
                reoriented_normals(&normals(heights.clone()), orientation),
                normals(reoriented(&heights, orientation)),
            );
            for (a, b) in a.grid().texels().iter().zip(b.grid().texels()) {
                assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-5), "{name}: {a:?} {b:?}");
            }
        }
    }

    #[test]
    fn four_quarters_and_two_flips_are_nothing() {
        let grid = Grid::from_fn(3, 2, |x, y| (x, y));
        let orientation = |grid: &Grid<(u32, u32)>, orientations: &[Orientation]| {
            orientations.iter().fold(grid.clone(), |g, &t| reoriented(&g, t))
        };
        assert_eq!(orientation(&grid, &[Orientation::Rotate90; 4]), grid);
        assert_eq!(orientation(&grid, &[Orientation::Rotate90, Orientation::Rotate270]), grid);
        assert_eq!(
            orientation(&grid, &[Orientation::FlipX, Orientation::FlipY]),
            orientation(&grid, &[Orientation::Rotate180])
        );
        // A quarter clockwise brings the top left to the top right.
        assert_eq!(*orientation(&grid, &[Orientation::Rotate90]).get(1, 0), (0, 0));
    }
}
