use relievo_map::{Grid, NormalMap};

/// A picture turned or flipped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Turn {
    /// A quarter clockwise.
    Right,
    /// Upside down.
    Half,
    /// A quarter counter-clockwise.
    Left,
    /// Left becomes right.
    FlipX,
    /// Top becomes bottom.
    FlipY,
}

impl Turn {
    /// All turns and their names.
    pub const ALL: [(&'static str, Self); 5] =
        [("90", Self::Right), ("180", Self::Half), ("270", Self::Left), ("x", Self::FlipX), ("y", Self::FlipY)];
}

/// The map turned, whatever its texels are; vectors in them stay as they are.
#[must_use]
pub fn turned<T: Clone>(grid: &Grid<T>, turn: Turn) -> Grid<T> {
    let (w, h) = (grid.width(), grid.height());
    match turn {
        Turn::Right => Grid::from_fn(h, w, |x, y| grid.get(y, h - 1 - x).clone()),
        Turn::Half => Grid::from_fn(w, h, |x, y| grid.get(w - 1 - x, h - 1 - y).clone()),
        Turn::Left => Grid::from_fn(h, w, |x, y| grid.get(w - 1 - y, x).clone()),
        Turn::FlipX => Grid::from_fn(w, h, |x, y| grid.get(w - 1 - x, y).clone()),
        Turn::FlipY => Grid::from_fn(w, h, |x, y| grid.get(x, h - 1 - y).clone()),
    }
}

/// Normals turned with their map: they are those of the turned heights.
#[must_use]
pub fn turned_normals(map: &NormalMap, turn: Turn) -> NormalMap {
    // In the picture, +Y up.
    let vector = |&[x, y, z]: &[f32; 3]| match turn {
        Turn::Right => [y, -x, z],
        Turn::Half => [-x, -y, z],
        Turn::Left => [-y, x, z],
        Turn::FlipX => [-x, y, z],
        Turn::FlipY => [x, -y, z],
    };
    NormalMap::new(turned(&map.grid().map(vector), turn))
}

#[cfg(test)]
mod tests {
    use super::*;
    use relievo_map::{Border, DerivativeKernel, HeightMap, height_to_normal};

    #[test]
    fn turned_normals_are_those_of_the_turned_heights() {
        let heights = Grid::from_fn(24, 24, |x, y| {
            let (u, v) = (x as f32 / 24.0 - 0.4, y as f32 / 24.0 - 0.6);
            (1.0 - 3.0 * u * u - 2.0 * v * v + 0.5 * u * v).max(0.0)
        });
        let normals = |g: Grid<f32>| height_to_normal(&HeightMap::new(g), 0.2, DerivativeKernel::Central, Border::Open);
        for (name, turn) in Turn::ALL {
            let (a, b) = (turned_normals(&normals(heights.clone()), turn), normals(turned(&heights, turn)));
            for (a, b) in a.grid().texels().iter().zip(b.grid().texels()) {
                assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-5), "{name}: {a:?} {b:?}");
            }
        }
    }

    #[test]
    fn four_quarters_and_two_flips_are_nothing() {
        let grid = Grid::from_fn(3, 2, |x, y| (x, y));
        let turn = |grid: &Grid<(u32, u32)>, turns: &[Turn]| turns.iter().fold(grid.clone(), |g, &t| turned(&g, t));
        assert_eq!(turn(&grid, &[Turn::Right; 4]), grid);
        assert_eq!(turn(&grid, &[Turn::Right, Turn::Left]), grid);
        assert_eq!(turn(&grid, &[Turn::FlipX, Turn::FlipY]), turn(&grid, &[Turn::Half]));
        // A quarter clockwise brings the top left to the top right.
        assert_eq!(*turn(&grid, &[Turn::Right]).get(1, 0), (0, 0));
    }
}
