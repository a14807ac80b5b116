use rayon::prelude::*;
use relievo_map::Grid;

use super::node::{BITS, Node, SLACK};
use super::window_maxima::WindowMaxima;

/// A rectangle of texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TexelRect {
    /// The first column and row.
    pub min: [u32; 2],
    /// Columns and rows.
    pub size: [u32; 2],
}

/// The max pyramid of one height map, sixteen blocks to a texel.
///
/// Cell (i, j) is the bilinear patch between the centres of texels i, i+1 and j, j+1; it is nowhere above its highest
/// corner. A node of level 1 holds the maxima of 4×4 cells, one of level n + 1 those of 4×4 nodes of level n, up to the level
/// that is a single node. Heights are quantized
/// to 8 bits and rounded up: a block may look higher than it is, never lower. The last column and row
/// of cells reach over the border to the first texels, so that one pyramid serves every wrap mode.
///
/// After the maximum mipmaps of Tevs, Ihrke and Seidel (2008); sixteen to a node, as wide bounding volume trees have them
/// (Dammertz, Hanika and Keller 2008), because a march waits for loads and not for comparisons.
#[derive(Clone, Debug)]
pub struct MaxPyramid {
    size: [u32; 2],
    low: f32,
    step: f32,
    /// All levels, the finest first.
    nodes: Vec<Node>,
    levels: Vec<LevelSpan>,
    clearance: f32,
    windows: WindowMaxima,
}

/// Compares the maxima of all blocks.
impl PartialEq for MaxPyramid {
    fn eq(&self, other: &Self) -> bool {
        (self.size, self.quantization(), &self.nodes) == (other.size, other.quantization(), &other.nodes)
    }
}

/// The range of a level's nodes among all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct LevelSpan {
    size: [u32; 2],
    start: usize,
}

impl LevelSpan {
    fn count(self) -> usize {
        self.size[0] as usize * self.size[1] as usize
    }
}

/// The nodes of one level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PyramidLevel<'a> {
    size: [u32; 2],
    nodes: &'a [Node],
}

impl<'a> PyramidLevel<'a> {
    /// Returns the nodes along u and v.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the nodes, row by row.
    #[must_use]
    pub fn nodes(&self) -> &'a [Node] {
        self.nodes
    }
}

impl MaxPyramid {
    /// Builds the pyramid of a height map, on all cores; the result does not depend on their number.
    ///
    /// `is_8_bit`: all heights are multiples of 1/255, which are then kept exactly; else the map's own range is divided into
    /// 255 steps.
    #[must_use]
    pub fn build(map: &Grid<f32>, is_8_bit: bool) -> Self {
        let texels = map.texels();
        let range = |[low, high]: [f32; 2], &h: &f32| [low.min(h), high.max(h)];
        let join = |a: [f32; 2], b: [f32; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        let [low, high] = texels
            .par_chunks(1 << 16)
            .map(|chunk| chunk.iter().fold([1.0f32, 0.0], range))
            .reduce(|| [1.0f32, 0.0], join);
        let (low, step) = if is_8_bit || !(low < high) { (0.0, 1.0 / 255.0) } else { (low, (high - low) / 255.0) };
        let size = [map.width(), map.height()];
        let (mut levels, mut count) = (Vec::new(), 0);
        let mut blocks = size;
        loop {
            blocks = blocks.map(|n| n.div_ceil(1 << BITS));
            let level = LevelSpan { size: blocks, start: count };
            levels.push(level);
            count += level.count();
            if blocks == [1, 1] {
                break;
            }
        }
        // An update may bring any height that nodes can hold.
        let windows = WindowMaxima::new(map, [low, low + 255.0 * step]);
        let mut pyramid = Self { size, low, step, nodes: vec![[0; 16]; count], levels, clearance: 0.0, windows };
        pyramid.fill(map, [[0; 2], pyramid.levels[0].size]);
        pyramid.clearance = pyramid.mean_clearance();
        pyramid
    }

    /// Takes over a changed part of the map: only the blocks that it touches are computed anew. The quantization stays that of
    /// the old range; where new heights leave it, all is built anew.
    ///
    /// # Panics
    /// If `map` has another size than the one the pyramid was built of, or `dirty` is not inside it.
    pub fn update(&mut self, map: &Grid<f32>, dirty: TexelRect, is_8_bit: bool) {
        assert_eq!(self.size, [map.width(), map.height()], "the map has the size that the pyramid was built for");
        let inside = |k: usize| dirty.min[k].checked_add(dirty.size[k]).is_some_and(|end| end <= self.size[k]);
        assert!(inside(0) && inside(1), "the changed texels are inside the map");
        if dirty.size.contains(&0) {
            return;
        }
        let top = self.height(u8::MAX);
        let fits = |h: &f32| {
            *h >= self.low
                && *h <= top
                && (!is_8_bit || (self.height(self.quantized(*h)) - *h).abs() < 1e-3 * self.step)
        };
        let rows = dirty.min[1]..dirty.min[1] + dirty.size[1];
        let row = |y: u32| (y * self.size[0] + dirty.min[0]) as usize;
        if !rows.clone().all(|y| map.texels()[row(y)..row(y) + dirty.size[0] as usize].iter().all(fits)) {
            *self = Self::build(map, is_8_bit);
            return;
        }
        // The cells to the left of a texel and above it have it as a corner too; those of the first one are the last.
        let spans = [0, 1].map(|k: usize| {
            let end = dirty.min[k] + dirty.size[k];
            match dirty.min[k] {
                0 => [Some((self.size[k] - 1, self.size[k])), Some((0, end))],
                first => [Some((first - 1, end)), None],
            }
        });
        for x in spans[0].into_iter().flatten() {
            for y in spans[1].into_iter().flatten() {
                let node = |cell: u32| cell >> BITS;
                self.fill(map, [[node(x.0), node(y.0)], [node(x.1 - 1) + 1, node(y.1 - 1) + 1]]);
            }
        }
        self.clearance = self.mean_clearance();
    }

    /// Returns the cells (and texels) along u and v.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the height of a quantized height.
    #[inline]
    #[must_use]
    pub fn height(&self, quantized: u8) -> f32 {
        self.low + f32::from(quantized) * self.step
    }

    /// Returns the quantization: the height of 0, and the difference in height between two steps.
    #[inline]
    #[must_use]
    pub fn quantization(&self) -> [f32; 2] {
        [self.low, self.step]
    }

    /// Returns the height above a block at which a march may pass over it: [`SLACK`], and the rounding of heights near 1.
    #[inline]
    pub(crate) fn slack(&self) -> f32 {
        SLACK * self.step + 4.0 * f32::EPSILON
    }

    /// Returns the number of levels; the last one is a single node.
    #[inline]
    #[must_use]
    pub fn top(&self) -> u32 {
        self.levels.len() as u32
    }

    /// Returns a level: from 1, the finest, to [`MaxPyramid::top`].
    ///
    /// # Panics
    /// If there is no such level.
    #[inline]
    #[must_use]
    pub fn level(&self, level: u32) -> PyramidLevel<'_> {
        let span = self.levels[level as usize - 1];
        PyramidLevel { size: span.size, nodes: &self.nodes[span.start..span.start + span.count()] }
    }

    /// Iterates over all levels, the finest first.
    pub fn levels(&self) -> impl Iterator<Item = PyramidLevel<'_>> {
        (1..=self.top()).map(|level| self.level(level))
    }

    /// Returns the maxima that packets of rays look up.
    #[inline]
    pub(crate) fn windows(&self) -> &WindowMaxima {
        &self.windows
    }

    /// Returns the mean distance of blocks of 4×4 cells from the highest point of the map, in height: the depth that a ray
    /// sinks, unhindered, before it is worth looking closely.
    #[inline]
    #[must_use]
    pub fn clearance(&self) -> f32 {
        self.clearance
    }

    /// Returns the level at which to begin a march that is likely to go this many texels before it comes near the surface.
    #[inline]
    #[must_use]
    pub fn start_level(&self, texels: f32) -> u32 {
        // Fewest fetches on the maps of docs/exact.md; either neighbour costs half a fetch.
        let level = match texels {
            t if t >= 128.0 => 4,
            t if t >= 16.0 => 3,
            t if t >= 2.0 => 2,
            _ => 1,
        };
        level.min(self.top())
    }

    /// Returns the bytes of all nodes: the data of a GPU's texture.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice())
    }

    /// Returns the bytes of the maxima that [`crate::march_all`] looks up, beside the nodes.
    #[must_use]
    pub fn window_bytes(&self) -> usize {
        self.windows.bytes()
    }

    /// Returns the smallest quantized height that is not below `h`, but for the rounding of f32: [`SLACK`] is more.
    fn quantized(&self, h: f32) -> u8 {
        ((h - self.low) / self.step - 1e-3).ceil() as u8
    }

    /// Computes the nodes of level 1 in a rectangle (lower corner, upper corner exclusive), and all above them.
    fn fill(&mut self, map: &Grid<f32>, [mut min, mut max]: [[u32; 2]; 2]) {
        let size = self.size;
        let texels = map.texels();
        let mut nodes = std::mem::take(&mut self.nodes);
        let after = |i: u32, n: u32| if i + 1 == n { 0 } else { i + 1 };
        let highest = |x: u32, y: u32| {
            let (x1, y1) = (after(x, size[0]), after(y, size[1]));
            let at = |x: u32, y: u32| texels[y as usize * size[0] as usize + x as usize];
            self.quantized(at(x, y).max(at(x1, y)).max(at(x, y1).max(at(x1, y1))))
        };
        let finest = self.levels[0];
        fill_level(&mut nodes[..finest.count()], finest.size[0], [min, max], size, highest);
        self.windows.fill(map, [min, max]);
        for pair in self.levels.windows(2) {
            min = min.map(|n| n >> BITS);
            max = max.map(|n| ((n - 1) >> BITS) + 1);
            let (below, above) = nodes.split_at_mut(pair[1].start);
            let (below, width) = (&below[pair[0].start..], pair[0].size[0] as usize);
            let highest = |x: u32, y: u32| {
                let node = below[y as usize * width + x as usize];
                node.into_iter().fold(0, u8::max)
            };
            fill_level(&mut above[..pair[1].count()], pair[1].size[0], [min, max], pair[0].size, highest);
        }
        self.nodes = nodes;
    }

    /// Distorts all quantized heights, for tests that must notice.
    #[cfg(test)]
    pub(crate) fn map_quantized(&mut self, change: impl Fn(u8) -> u8) {
        self.nodes.as_flattened_mut().iter_mut().for_each(|height| *height = change(*height));
        self.windows.map_quantized(&change);
    }

    fn mean_clearance(&self) -> f32 {
        let count = self.level(1).nodes.len() as u64;
        let top = u64::from(self.level(self.top()).nodes[0].into_iter().fold(0, u8::max));
        if self.top() < 2 {
            return 0.0;
        }
        // A block of 4×4 cells is one byte of level 2; beyond the map bytes are 0.
        let level = self.level(2);
        let sum: u64 = level.nodes.iter().flatten().map(|&height| u64::from(height)).sum();
        // As the GPU computes it.
        (top * count - sum) as f32 / count as f32 * self.step
    }
}

/// Fills the nodes of a rectangle from the maxima of the `blocks` below them.
fn fill_level(
    nodes: &mut [Node],
    width: u32,
    [min, max]: [[u32; 2]; 2],
    blocks: [u32; 2],
    highest: impl Fn(u32, u32) -> u8 + Sync,
) {
    let rows = nodes.par_chunks_mut(width as usize).enumerate();
    rows.skip(min[1] as usize).take((max[1] - min[1]) as usize).for_each(|(row, nodes)| {
        for column in min[0]..max[0] {
            nodes[column as usize] = std::array::from_fn(|k| {
                let [x, y] = [(column << BITS) + (k as u32 & 3), ((row as u32) << BITS) + (k as u32 >> BITS)];
                if x < blocks[0] && y < blocks[1] { highest(x, y) } else { 0 }
            });
        }
    });
}
