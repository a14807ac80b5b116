use relievo_map::Wrap;

use super::cone_map::ConeMap;

/// A map's cones with an addressing mode.
#[derive(Clone, Copy, Debug)]
pub struct ConeField<'a> {
    pub(crate) map: &'a ConeMap,
    wrap: Wrap,
}

/// The reach of a stretch of cells that goes on for ever.
pub(super) const ENDLESS: i32 = 1 << 30;

impl<'a> ConeField<'a> {
    /// Joins the cones of a map with its addressing mode: the value of [`crate::HeightField::cones`].
    #[must_use]
    pub fn new(map: &'a ConeMap, wrap: Wrap) -> Self {
        Self { map, wrap }
    }

    /// Returns the cone of a cell, any of the endless rows and columns.
    #[inline]
    pub(crate) fn at(&self, cell: [i32; 2]) -> [u8; 2] {
        let [x, y] = [0, 1].map(|k| {
            let index = |i: i32| self.wrap.index(i, self.map.size[k]);
            match self.wrap {
                Wrap::Repeat => index(cell[k]),
                // A cell lies between two texels; where the map is mirrored, they come in the other order.
                Wrap::Clamp | Wrap::Mirror => index(cell[k]).min(index(cell[k].wrapping_add(1))),
            }
        });
        self.map.texels[y as usize * self.map.size[0] as usize + x as usize]
    }

    /// Returns the number of cells that a ray going by `step` (±1) along an axis enters from cell `i` until the relaxed cone of
    /// that cell holds no more: a tile away, or beyond the border where the neighbourhood is another one than the map's.
    #[inline]
    pub(crate) fn reach(&self, i: i32, step: i32, axis: usize) -> i32 {
        let n = self.map.size[axis] as i32;
        // The cells on a border that is not the tiling map's are a stretch of their own.
        let [up, down] = match self.wrap {
            Wrap::Repeat => [n, n],
            Wrap::Clamp => match i {
                i if i < 0 => [i.saturating_neg(), ENDLESS],
                i if i < n - 1 => [n - 1 - i, i + 1],
                i => [ENDLESS, i - n + 2],
            },
            Wrap::Mirror => match i.wrapping_add(1).rem_euclid(2 * n) {
                r if r % n == 0 => [1, 1],
                r if r < n => [n - r, r],
                r => [2 * n - r, r - n],
            },
        };
        if step > 0 { up } else { down }
    }
}

#[cfg(test)]
mod tests {
    use relievo_map::Grid;

    use super::*;
    use crate::{Cones, MaxPyramid};

    #[test]
    fn cells_beyond_the_border_have_the_cones_of_those_whose_texels_they_show() {
        let map = Grid::from_fn(3, 1, |x, _| x as f32 / 2.0);
        let mut cones = ConeMap::build(&map, &MaxPyramid::build(&map, false), Cones::Relaxed);
        cones.texels = vec![[0, 0], [1, 0], [2, 0]];
        let seen =
            |wrap| (-5..8).map(|i| ConeField::new(&cones, wrap).at([i, 0])[0]).map(i32::from).collect::<Vec<_>>();
        assert_eq!(seen(Wrap::Repeat), [1, 2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1]);
        assert_eq!(seen(Wrap::Clamp), [0, 0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2, 2]);
        // Texels 1 2 2 1 0 0 1 2 2 1 0 0 1 2 from −5 on.
        assert_eq!(seen(Wrap::Mirror), [1, 2, 1, 0, 0, 0, 1, 2, 1, 0, 0, 0, 1]);
        let ends = |wrap, step| (-5..8).map(|i| ConeField::new(&cones, wrap).reach(i, step, 0)).collect::<Vec<_>>();
        let never = ENDLESS;
        assert_eq!(ends(Wrap::Repeat, 1), [3; 13]);
        assert_eq!(ends(Wrap::Clamp, 1)[..7], [5, 4, 3, 2, 1, 2, 1]);
        assert_eq!(ends(Wrap::Clamp, 1)[7..], [never; 6]);
        assert_eq!(ends(Wrap::Clamp, -1)[..5], [never; 5]);
        assert_eq!(ends(Wrap::Clamp, -1)[5..], [1, 2, 1, 2, 3, 4, 5, 6]);
        // Cells −4, −1, 2, 5 stand between a texel and its image.
        assert_eq!(ends(Wrap::Mirror, 1), [1, 1, 2, 1, 1, 2, 1, 1, 2, 1, 1, 2, 1]);
        assert_eq!(ends(Wrap::Mirror, -1), [2, 1, 1, 2, 1, 1, 2, 1, 1, 2, 1, 1, 2]);
    }
}
