//! How cone maps are made: for each cell the steepest line from its top to a cell that limits it, by branch and bound in a
//! pyramid of maxima. What is found is what comparing all pairs of cells would find, to the last code.

use rayon::prelude::*;
use relievo_map::Grid;

use crate::cone_map::{block_code, slope, slope_code};
use crate::pyramid::BITS;
use crate::{Cones, MaxPyramid};

/// A set of octants of directions, a bit each: 1 where x points down, 2 where y does, 4 where y is the longer part.
type Octants = u8;

/// Top and slope of every cell, as codes, row by row.
pub(crate) fn build(map: &Grid<f32>, pyramid: &MaxPyramid, cones: Cones) -> Vec<[u8; 2]> {
    match cones {
        Cones::Conservative => search_all(pyramid, &Higher(pyramid)),
        Cones::Relaxed => search_all(pyramid, &Falling::new(map, pyramid)),
    }
}

/// Which cells limit a cone.
trait Limits: Sync {
    /// The highest code in a block of 4^level cells of those that may limit a cone which they are seen from in these
    /// directions; never too low.
    fn highest(&self, level: u32, at: [u32; 2], directions: Octants) -> u8;

    /// Whether a cell limits a cone that is so many texels away, counted from the cone's cell.
    fn limits(&self, at: [u32; 2], way: [i32; 2]) -> bool;
}

/// Every cell does.
struct Higher<'a>(&'a MaxPyramid);

impl Limits for Higher<'_> {
    #[inline]
    fn highest(&self, level: u32, at: [u32; 2], _: Octants) -> u8 {
        block_code(self.0, level, at)
    }

    #[inline]
    fn limits(&self, _: [u32; 2], _: [i32; 2]) -> bool {
        true
    }
}

/// Those do whose surface may fall somewhere on the way outwards.
struct Falling<'a> {
    map: &'a Grid<f32>,
    pyramid: &'a MaxPyramid,
    /// The octants in which each cell may fall.
    octants: Vec<Octants>,
    /// From level 1 on: blocks along u, and the highest code of cells that may fall, by octant.
    levels: Vec<(u32, Vec<[u8; 8]>)>,
}

impl<'a> Falling<'a> {
    fn new(map: &'a Grid<f32>, pyramid: &'a MaxPyramid) -> Self {
        let size = pyramid.size();
        let mut octants = vec![0; map.texels().len()];
        octants.par_chunks_mut(size[0] as usize).enumerate().for_each(|(y, row)| {
            for (x, octants) in row.iter_mut().enumerate() {
                *octants = octants_of_fall(slopes(map, [x as u32, y as u32]));
            }
        });
        let mut falling = Self { map, pyramid, octants, levels: Vec::new() };
        let mut below = size;
        for level in 1..=pyramid.top() {
            let blocks = below.map(|n| n.div_ceil(1 << BITS));
            let mut codes = vec![[0; 8]; blocks[0] as usize * blocks[1] as usize];
            codes.par_chunks_mut(blocks[0] as usize).enumerate().for_each(|(y, row)| {
                for (x, codes) in row.iter_mut().enumerate() {
                    for k in 0..1 << (2 * BITS) {
                        let child = [(x << BITS) as u32 + (k & 3), (y << BITS) as u32 + (k >> BITS)];
                        if child[0] < below[0] && child[1] < below[1] {
                            let higher = falling.codes(level - 1, child);
                            codes.iter_mut().zip(higher).for_each(|(code, higher)| *code = higher.max(*code));
                        }
                    }
                }
            });
            falling.levels.push((blocks[0], codes));
            below = blocks;
        }
        falling
    }

    /// The highest codes of a block by octant.
    #[inline]
    fn codes(&self, level: u32, at: [u32; 2]) -> [u8; 8] {
        if level == 0 {
            let octants = self.octants[(at[1] * self.pyramid.size()[0] + at[0]) as usize];
            let top = block_code(self.pyramid, 0, at);
            return std::array::from_fn(|k| if octants >> k & 1 == 0 { 0 } else { top });
        }
        let (width, codes) = &self.levels[level as usize - 1];
        codes[(at[1] * width + at[0]) as usize]
    }
}

impl Limits for Falling<'_> {
    #[inline]
    fn highest(&self, level: u32, at: [u32; 2], directions: Octants) -> u8 {
        if level == 0 {
            let octants = self.octants[(at[1] * self.pyramid.size()[0] + at[0]) as usize];
            return if octants & directions == 0 { 0 } else { block_code(self.pyramid, 0, at) };
        }
        let codes = self.codes(level, at);
        (0..8).fold(0, |highest, k| if directions >> k & 1 == 0 { highest } else { highest.max(codes[k]) })
    }

    #[inline]
    fn limits(&self, at: [u32; 2], way: [i32; 2]) -> bool {
        let along = way.map(|d| [(d - 1) as f32, (d + 1) as f32]);
        may_fall(slopes(self.map, at), along)
    }
}

/// The least and the largest slope of a cell's surface along both axes.
fn slopes(map: &Grid<f32>, [x, y]: [u32; 2]) -> [[f32; 2]; 2] {
    let next = |i: u32, n: u32| if i + 1 == n { 0 } else { i + 1 };
    let (x1, y1) = (next(x, map.width()), next(y, map.height()));
    let [h00, h10, h01, h11] = [(x, y), (x1, y), (x, y1), (x1, y1)].map(|(x, y)| *map.get(x, y));
    let range = |a: f32, b: f32| [a.min(b), a.max(b)];
    [range(h10 - h00, h11 - h01), range(h01 - h00, h11 - h10)]
}

/// Whether a surface of these slopes falls along some direction of a box of directions.
fn may_fall(slopes: [[f32; 2]; 2], along: [[f32; 2]; 2]) -> bool {
    let least = |[a, b]: [f32; 2], [c, d]: [f32; 2]| (a * c).min(a * d).min((b * c).min(b * d));
    least(slopes[0], along[0]) + least(slopes[1], along[1]) < 0.0
}

/// The octants with a direction in which a surface of these slopes falls.
fn octants_of_fall(slopes: [[f32; 2]; 2]) -> Octants {
    (0..8).fold(0, |octants, k| {
        let along = |k: usize, bit: u8| if bit == 0 { slopes[k][0] } else { -slopes[k][1] };
        let (x, y) = (along(0, k & 1), along(1, k >> 1 & 1));
        // Directions between an axis and a diagonal fall most along one of the two.
        let falls = x + y < 0.0 || (if k & 4 == 0 { x } else { y }) < 0.0;
        octants | u8::from(falls) << k
    })
}

/// The octants that a box of directions reaches into, and perhaps some more.
#[inline]
fn octants_of(along: [[i32; 2]; 2]) -> Octants {
    let side = |[low, high]: [i32; 2], up: u8| (if high > 0 { up } else { 0 }) | (if low < 0 { !up } else { 0 });
    let nearest = along.map(|[low, high]| low.max(-high).max(0));
    let farthest = along.map(|[low, high]| high.max(-low));
    let longer =
        (if farthest[0] >= nearest[1] { 0x0f } else { 0 }) | (if farthest[1] >= nearest[0] { 0xf0 } else { 0 });
    side(along[0], 0x55) & side(along[1], 0x33) & longer
}

fn search_all(pyramid: &MaxPyramid, limits: &impl Limits) -> Vec<[u8; 2]> {
    let [width, height] = pyramid.size();
    let mut texels = vec![[0; 2]; width as usize * height as usize];
    // Rows know nothing of each other: what is found does not depend on the threads.
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
    /// Blocks to be opened, with how high they rise, and the square of the gap to them.
    stack: Vec<(Block, i32, i64)>,
    cell: [i32; 2],
    top: i32,
    /// The steepest slope so far, and what it is rounded to.
    code: u8,
    slope: f64,
    /// The cell that gave it.
    seed: Option<Block>,
}

impl<L: Limits> Search<'_, L> {
    fn cone(&mut self, cell: [u32; 2]) -> [u8; 2] {
        let top = block_code(self.pyramid, 0, cell);
        (self.cell, self.top, self.code, self.slope) = (cell.map(|i| i as i32), top.into(), 0, 0.0);
        // What limits a cell is likely to limit its neighbour too: most blocks need not be opened.
        if let Some(seed) = self.seed.take() {
            self.look_at(seed);
        }
        let size = self.pyramid.size().map(|n| n as i32);
        let root = self.pyramid.top();
        // Every place has its nearest image in one of these tiles.
        for tile in [-1, 0, 1].into_iter().flat_map(|y| [-1, 0, 1].map(|x| [x * size[0], y * size[1]])) {
            self.look_at(Block { level: root, at: [0; 2], tile });
        }
        while let Some((block, rise, gap)) = self.stack.pop() {
            if self.is_steeper(rise, gap) {
                self.open(block);
            }
        }
        [top, self.code]
    }

    /// Whether a rise at such a gap makes for a steeper slope than the one there is, rounded.
    #[inline]
    fn is_steeper(&self, rise: i32, squared_gap: i64) -> bool {
        // rise/(gap + 1) > slope, without the root.
        let far = f64::from(rise) / self.slope - 1.0;
        far > 0.0 && far * far > squared_gap as f64
    }

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

    #[inline]
    fn look_at(&mut self, block: Block) {
        let shift = BITS * block.level;
        let size = self.pyramid.size();
        let along: [[i32; 2]; 2] = std::array::from_fn(|k| {
            let last = ((block.at[k] + 1) << shift).min(size[k]) - 1;
            [(block.at[k] << shift) as i32, last as i32].map(|i| i + block.tile[k] - self.cell[k])
        });
        let gap = along.map(|[first, last]| i64::from((first - 1).max(-last - 1).max(0)));
        let squared = gap[0] * gap[0] + gap[1] * gap[1];
        // Most blocks are out of the question whatever limits cones.
        let steeper = |code: u8| {
            let rise = i32::from(code) - self.top;
            (rise > 0 && self.is_steeper(rise, squared)).then_some(rise)
        };
        if steeper(block_code(self.pyramid, block.level, block.at)).is_none() {
            return;
        }
        let directions = octants_of(along.map(|[first, last]| [first - 1, last + 1]));
        let Some(rise) = steeper(self.limits.highest(block.level, block.at, directions)) else { return };
        if block.level > 0 {
            self.stack.push((block, rise, squared));
        } else if self.limits.limits(block.at, along.map(|[first, _]| first)) {
            self.code = slope_code(f64::from(rise) / ((squared as f64).sqrt() + 1.0));
            self.slope = slope(self.code).into();
            self.seed = Some(block);
        }
    }
}
