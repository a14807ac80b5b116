//! The cells that limit a cone, by kind of cone and by direction.

use rayon::prelude::*;
use relievo_map::Grid;

use crate::MaxPyramid;
use crate::pyramid::{BITS, child_index};

/// A set of octants of directions, one bit each: 1 where x points down, 2 where y does, 4 where y is the longer part.
pub(super) type Octants = u8;

/// The cells that limit a cone.
pub(super) trait Limits: Sync {
    /// Returns the greatest quantized height in a block of 4^level cells of those that may limit a cone which sees them in
    /// these directions; never too low.
    fn highest(&self, level: u32, at: [u32; 2], directions: Octants) -> u8;

    /// Returns true if a cell limits a cone; `offset` leads from the cone's cell to it, in texels.
    fn limits(&self, at: [u32; 2], offset: [i32; 2]) -> bool;
}

/// All cells limit a cone.
pub(super) struct Higher<'a>(pub(super) &'a MaxPyramid);

impl Limits for Higher<'_> {
    #[inline]
    fn highest(&self, level: u32, at: [u32; 2], _: Octants) -> u8 {
        block_maximum(self.0, level, at)
    }

    #[inline]
    fn limits(&self, _: [u32; 2], _: [i32; 2]) -> bool {
        true
    }
}

/// The cells limit a cone whose surface may fall somewhere in the outward direction.
pub(super) struct Falling<'a> {
    map: &'a Grid<f32>,
    pyramid: &'a MaxPyramid,
    /// The octants in which each cell may fall.
    octants: Vec<Octants>,
    /// From level 1 on: blocks along u, and the greatest quantized height of cells that may fall, by octant.
    levels: Vec<(u32, Vec<[u8; 8]>)>,
}

impl<'a> Falling<'a> {
    pub(super) fn new(map: &'a Grid<f32>, pyramid: &'a MaxPyramid) -> Self {
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
            let mut maxima = vec![[0; 8]; blocks[0] as usize * blocks[1] as usize];
            maxima.par_chunks_mut(blocks[0] as usize).enumerate().for_each(|(y, row)| {
                for (x, maxima) in row.iter_mut().enumerate() {
                    for k in 0..1 << (2 * BITS) {
                        let child = [(x << BITS) as u32 + (k & 3), (y << BITS) as u32 + (k >> BITS)];
                        if child[0] < below[0] && child[1] < below[1] {
                            let below = falling.maxima(level - 1, child);
                            maxima.iter_mut().zip(below).for_each(|(maximum, below)| *maximum = below.max(*maximum));
                        }
                    }
                }
            });
            falling.levels.push((blocks[0], maxima));
            below = blocks;
        }
        falling
    }

    /// Returns the greatest quantized heights of a block by octant.
    #[inline]
    fn maxima(&self, level: u32, at: [u32; 2]) -> [u8; 8] {
        if level == 0 {
            let octants = self.octants[(at[1] * self.pyramid.size()[0] + at[0]) as usize];
            let top = block_maximum(self.pyramid, 0, at);
            return std::array::from_fn(|k| if octants >> k & 1 == 0 { 0 } else { top });
        }
        let (width, maxima) = &self.levels[level as usize - 1];
        maxima[(at[1] * width + at[0]) as usize]
    }
}

impl Limits for Falling<'_> {
    #[inline]
    fn highest(&self, level: u32, at: [u32; 2], directions: Octants) -> u8 {
        if level == 0 {
            let octants = self.octants[(at[1] * self.pyramid.size()[0] + at[0]) as usize];
            return if octants & directions == 0 { 0 } else { block_maximum(self.pyramid, 0, at) };
        }
        let maxima = self.maxima(level, at);
        (0..8).fold(0, |highest, k| if directions >> k & 1 == 0 { highest } else { highest.max(maxima[k]) })
    }

    #[inline]
    fn limits(&self, at: [u32; 2], offset: [i32; 2]) -> bool {
        let along = offset.map(|d| [(d - 1) as f32, (d + 1) as f32]);
        may_fall(slopes(self.map, at), along)
    }
}

/// Returns the least and the largest slope of a cell's surface along both axes.
fn slopes(map: &Grid<f32>, [x, y]: [u32; 2]) -> [[f32; 2]; 2] {
    let after = |i: u32, n: u32| if i + 1 == n { 0 } else { i + 1 };
    let (x1, y1) = (after(x, map.width()), after(y, map.height()));
    let [h00, h10, h01, h11] = [(x, y), (x1, y), (x, y1), (x1, y1)].map(|(x, y)| *map.get(x, y));
    let range = |a: f32, b: f32| [a.min(b), a.max(b)];
    [range(h10 - h00, h11 - h01), range(h01 - h00, h11 - h10)]
}

/// Returns true if a surface of these slopes falls along some direction of a box of directions.
fn may_fall(slopes: [[f32; 2]; 2], along: [[f32; 2]; 2]) -> bool {
    let least = |[a, b]: [f32; 2], [c, d]: [f32; 2]| (a * c).min(a * d).min((b * c).min(b * d));
    least(slopes[0], along[0]) + least(slopes[1], along[1]) < 0.0
}

/// Returns the octants with a direction in which a surface of these slopes falls.
fn octants_of_fall(slopes: [[f32; 2]; 2]) -> Octants {
    (0..8).fold(0, |octants, k| {
        let along = |k: usize, bit: u8| if bit == 0 { slopes[k][0] } else { -slopes[k][1] };
        let (x, y) = (along(0, k & 1), along(1, k >> 1 & 1));
        // Directions between an axis and a diagonal fall most along one of the two.
        let falls = x + y < 0.0 || (if k & 4 == 0 { x } else { y }) < 0.0;
        octants | u8::from(falls) << k
    })
}

/// Returns the octants that a box of directions reaches into, and perhaps some more.
#[inline]
pub(super) fn octants_of(along: [[i32; 2]; 2]) -> Octants {
    let side = |[low, high]: [i32; 2], up: u8| (if high > 0 { up } else { 0 }) | (if low < 0 { !up } else { 0 });
    let nearest = along.map(|[low, high]| low.max(-high).max(0));
    let farthest = along.map(|[low, high]| high.max(-low));
    let longer =
        (if farthest[0] >= nearest[1] { 0x0f } else { 0 }) | (if farthest[1] >= nearest[0] { 0xf0 } else { 0 });
    side(along[0], 0x55) & side(along[1], 0x33) & longer
}

/// Returns the quantized maximum of a pyramid's block. Level 0 are cells, a block of level l spans 4^l of them.
#[inline]
pub(super) fn block_maximum(pyramid: &MaxPyramid, level: u32, [x, y]: [u32; 2]) -> u8 {
    if level == pyramid.top() {
        return pyramid.level(level).nodes()[0].into_iter().fold(0, u8::max);
    }
    let nodes = pyramid.level(level + 1);
    let node = &nodes.nodes()[((y >> BITS) * nodes.size()[0] + (x >> BITS)) as usize];
    node[child_index([x, y])]
}
