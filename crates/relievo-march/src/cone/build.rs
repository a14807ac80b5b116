//! The construction of cone maps: for each cell the steepest line from its top to a cell that limits it, by branch and bound
//! in a pyramid of maxima. The result is that of comparing all pairs of cells, to the last code.

use rayon::prelude::*;
use relievo_map::Grid;

use super::cones::Cones;
use super::limits::{Falling, Higher, Limits, block_maximum, octants_of};
use super::slope::{slope, slope_code};
use crate::MaxPyramid;
use crate::pyramid::BITS;

/// Builds the cones of every cell, row by row: quantized top and code of the slope.
pub(super) fn build(map: &Grid<f32>, pyramid: &MaxPyramid, cones: Cones) -> Vec<[u8; 2]> {
    match cones {
        Cones::Conservative => search_all(pyramid, &Higher(pyramid)),
        Cones::Relaxed => search_all(pyramid, &Falling::new(map, pyramid)),
    }
}

fn search_all(pyramid: &MaxPyramid, limits: &impl Limits) -> Vec<[u8; 2]> {
    let [width, height] = pyramid.size();
    let mut texels = vec![[0; 2]; width as usize * height as usize];
    // Rows are independent: the result does not depend on the threads.
    texels.par_chunks_mut(width as usize).enumerate().for_each(|(y, row)| {
        let mut search =
            Search { pyramid, limits, stack: Vec::new(), cell: [0; 2], top: 0, code: 0, slope: 0.0, seed: None };
        for (x, texel) in row.iter_mut().enumerate() {
            *texel = search.cone([x as u32, y as u32]);
        }
    });
    texels
}

/// A block of 4^level cells, of the tile that begins at `tile`.
#[derive(Clone, Copy)]
struct Block {
    level: u32,
    at: [u32; 2],
    tile: [i32; 2],
}

/// The search for one cone after another.
struct Search<'a, L> {
    pyramid: &'a MaxPyramid,
    limits: &'a L,
    /// Blocks to be opened, with their height above the cone's top and the square of the gap to them.
    stack: Vec<(Block, i32, i64)>,
    cell: [i32; 2],
    top: i32,
    /// The steepest slope so far, rounded: its code and value.
    code: u8,
    slope: f64,
    /// The cell that gave it.
    seed: Option<Block>,
}

impl<L: Limits> Search<'_, L> {
    /// Finds the cone of a cell.
    fn cone(&mut self, cell: [u32; 2]) -> [u8; 2] {
        let top = block_maximum(self.pyramid, 0, cell);
        (self.cell, self.top, self.code, self.slope) = (cell.map(|i| i as i32), top.into(), 0, 0.0);
        // The limit of a cell is likely to limit its neighbour too: most blocks need not be opened.
        if let Some(seed) = self.seed.take() {
            self.look_at(seed);
        }
        let size = self.pyramid.size().map(|n| n as i32);
        let root = self.pyramid.top();
        // Every place has its nearest image in one of these tiles.
        for tile in [-1, 0, 1].into_iter().flat_map(|y| [-1, 0, 1].map(|x| [x * size[0], y * size[1]])) {
            self.look_at(Block { level: root, at: [0; 2], tile });
        }
        while let Some((block, ascent, gap)) = self.stack.pop() {
            if self.is_steeper(ascent, gap) {
                self.open(block);
            }
        }
        [top, self.code]
    }

    /// Returns true if an ascent over such a gap is steeper than the steepest slope so far, rounded.
    #[inline]
    fn is_steeper(&self, ascent: i32, squared_gap: i64) -> bool {
        // ascent/(gap + 1) > slope, without the root.
        let far = f64::from(ascent) / self.slope - 1.0;
        far > 0.0 && far * far > squared_gap as f64
    }

    /// Looks at the 4×4 blocks in a block.
    fn open(&mut self, block: Block) {
        let level = block.level - 1;
        let count = self.pyramid.size().map(|n| n.div_ceil(1 << (BITS * level)));
        let opened = self.stack.len();
        for k in 0..1 << (2 * BITS) {
            let at = [(block.at[0] << BITS) + (k & 3), (block.at[1] << BITS) + (k >> BITS)];
            if at[0] < count[0] && at[1] < count[1] {
                self.look_at(Block { level, at, ..block });
            }
        }
        // The nearest comes first.
        self.stack[opened..].sort_unstable_by_key(|&(_, _, gap)| std::cmp::Reverse(gap));
    }

    /// Takes over the slope to a cell if it is steeper; keeps a block to be opened if a cell in it may be.
    #[inline]
    fn look_at(&mut self, block: Block) {
        let bit_shift = BITS * block.level;
        let size = self.pyramid.size();
        let along: [[i32; 2]; 2] = std::array::from_fn(|k| {
            let last = ((block.at[k] + 1) << bit_shift).min(size[k]) - 1;
            [(block.at[k] << bit_shift) as i32, last as i32].map(|i| i + block.tile[k] - self.cell[k])
        });
        let gap = along.map(|[first, last]| i64::from((first - 1).max(-last - 1).max(0)));
        let squared = gap[0] * gap[0] + gap[1] * gap[1];
        // Most blocks are too low whatever limits cones.
        let steeper = |maximum: u8| {
            let ascent = i32::from(maximum) - self.top;
            (ascent > 0 && self.is_steeper(ascent, squared)).then_some(ascent)
        };
        if steeper(block_maximum(self.pyramid, block.level, block.at)).is_none() {
            return;
        }
        let directions = octants_of(along.map(|[first, last]| [first - 1, last + 1]));
        let Some(ascent) = steeper(self.limits.highest(block.level, block.at, directions)) else { return };
        if block.level > 0 {
            self.stack.push((block, ascent, squared));
        } else if self.limits.limits(block.at, along.map(|[first, _]| first)) {
            self.code = slope_code(f64::from(ascent) / ((squared as f64).sqrt() + 1.0));
            self.slope = slope(self.code).into();
            self.seed = Some(block);
        }
    }
}
