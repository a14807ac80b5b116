use relievo_map::{Grid, Wrap};

use super::max_pyramid::MaxPyramid;
use super::node::{BITS, Node};

/// A map with its max pyramid and an addressing mode.
#[derive(Clone, Copy, Debug)]
pub struct PyramidField<'a> {
    pub(crate) cells: &'a Grid<f32>,
    pub(crate) pyramid: &'a MaxPyramid,
    pub(crate) wrap: Wrap,
}

impl<'a> PyramidField<'a> {
    /// Joins a map with a pyramid that was built of it and kept up to date: the value of [`crate::HeightField::pyramid`].
    ///
    /// # Panics
    /// If they differ in size.
    #[must_use]
    pub fn new(cells: &'a Grid<f32>, pyramid: &'a MaxPyramid, wrap: Wrap) -> Self {
        assert_eq!(pyramid.size(), [cells.width(), cells.height()], "the pyramid is that of the map");
        Self { cells, pyramid, wrap }
    }
}

impl PyramidField<'_> {
    #[inline(always)]
    pub(crate) fn node(&self, level: u32, at: [u32; 2]) -> &Node {
        let level = self.pyramid.level(level);
        &level.nodes()[(at[1] * level.size()[0] + at[0]) as usize]
    }

    /// Returns the node of a level that holds a cell.
    #[inline(always)]
    pub(crate) fn node_of(&self, level: u32, cell: [u32; 2]) -> &Node {
        self.node(level, cell.map(|i| i >> (BITS * level)))
    }

    /// Returns the heights h00, h10, h01, h11 of texels in these columns and rows.
    #[inline(always)]
    pub(crate) fn corners(&self, [x0, x1]: [usize; 2], [y0, y1]: [usize; 2]) -> [f32; 4] {
        let width = self.cells.width() as usize;
        let texels = self.cells.texels();
        let (top, bottom) = (&texels[y0 * width..(y0 + 1) * width], &texels[y1 * width..(y1 + 1) * width]);
        [top[x0], top[x1], bottom[x0], bottom[x1]]
    }
}
