use fearless_simd::{prelude::*, u32x16, u64x8};
use relievo_map::Wrap;

use super::lanes::{Floats, Ints, LANES, Mask};
use crate::MarchOptions;
use crate::pyramid::{PyramidField, WindowMaxima};

/// The map and options of a march of packets: the same for all rays.
pub(super) struct PacketContext<'a, S: Simd> {
    pub(super) simd: S,
    pub(super) map: PyramidField<'a>,
    pub(super) options: &'a MarchOptions,
    /// The depths that no texel rises above and none falls below.
    pub(super) lid: f32,
    pub(super) floor: f32,
    /// Columns and rows of the map.
    pub(super) size: [i32; 2],
    pub(super) texels: &'a [f32],
    pub(super) windows: &'a WindowMaxima,
    /// The depths down to which rays are above blocks of each quantized height.
    pub(super) depths: [f32; 256],
    /// The greatest difference between neighbouring texels.
    pub(super) steepest: f32,
}

impl<'a, S: Simd> PacketContext<'a, S> {
    #[inline(always)]
    pub(super) fn new(simd: S, map: PyramidField<'a>, range: [f32; 2], options: &'a MarchOptions) -> Self {
        let slack = map.pyramid.slack();
        let windows = map.pyramid.windows();
        Self {
            simd,
            options,
            lid: 1.0 - range[1],
            floor: 1.0 - range[0],
            size: map.pyramid.size().map(|n| n as i32),
            texels: map.cells.texels(),
            windows,
            depths: windows.heights().map(|h| 1.0 - h - slack),
            steepest: windows.steepest(),
            map,
        }
    }

    #[inline(always)]
    pub(super) fn splat(&self, x: f32) -> Floats<S> {
        Floats::splat(self.simd, x)
    }

    /// Returns the texel that stands for number `i` of the endless row, which is at most one repeat beside the map.
    #[inline(always)]
    fn texel(&self, i: Ints<S>, k: usize) -> Ints<S> {
        let n = self.size[k];
        let i = match self.map.wrap {
            Wrap::Repeat => {
                let i = i.simd_lt(0).select(i + n, i);
                i.simd_ge(n).select(i - n, i)
            }
            Wrap::Clamp => i,
            Wrap::Mirror => {
                let i = i.simd_lt(0).select(-i - 1, i);
                let i = i.simd_ge(2 * n).select(i - 2 * n, i);
                i.simd_ge(n).select(-i + (2 * n - 1), i)
            }
        };
        i.max(0).min(n - 1)
    }

    /// Returns the heights at the corners of cells: h00, h10, h01, h11. `inside`: all `active` cells are inside the map.
    #[inline(always)]
    pub(super) fn corners(&self, x: Ints<S>, y: Ints<S>, active: Mask<S>, inside: bool) -> [Floats<S>; 4] {
        let columns = self.size[0];
        if inside {
            return self.squares((y * columns + x) & active.to_vector());
        }
        // A function of its own, so that nothing of it is computed where it is not needed.
        self.simd.vectorize(
            #[inline(always)]
            || {
                let [x0, x1] = [self.texel(x, 0), self.texel(x + 1, 0)];
                let [top, bottom] = [self.texel(y, 1) * columns, self.texel(y + 1, 1) * columns];
                [self.heights(top + x0), self.heights(top + x1), self.heights(bottom + x0), self.heights(bottom + x1)]
            },
        )
    }

    /// Looks up the depths down to which rays are above these blocks of a table of quantized heights.
    #[inline(always)]
    pub(super) fn look_up(&self, table: &[u8], at: Ints<S>) -> Floats<S> {
        let at = at.bitcast::<u32x16<S>>().to_array();
        let mut depths = [0.0; LANES];
        for lane in 0..LANES {
            depths[lane] = self.depths[usize::from(table[at[lane] as usize])];
        }
        Floats::load_array(self.simd, depths)
    }

    /// Returns the heights of texels.
    #[inline(always)]
    fn heights(&self, at: Ints<S>) -> Floats<S> {
        let at = at.bitcast::<u32x16<S>>().to_array();
        let mut heights = [0.0; LANES];
        for lane in 0..LANES {
            heights[lane] = self.texels[at[lane] as usize];
        }
        Floats::load_array(self.simd, heights)
    }

    /// Returns the heights of texels, of their neighbours to the right, and of the two texels below.
    #[inline(always)]
    fn squares(&self, at: Ints<S>) -> [Floats<S>; 4] {
        let at = at.bitcast::<u32x16<S>>().to_array();
        let columns = self.size[0] as u32 as usize;
        let (mut top, mut bottom) = ([0; LANES], [0; LANES]);
        let pair = |heights: &[f32]| u64::from(heights[0].to_bits()) | u64::from(heights[1].to_bits()) << 32;
        for lane in 0..LANES {
            let at = at[lane] as usize;
            let heights = &self.texels[at..at + columns + 2];
            (top[lane], bottom[lane]) = (pair(heights), pair(&heights[columns..]));
        }
        let columns = |pairs: [u64; LANES]| {
            let [low, high] = [0, 1].map(|k| {
                let half = &pairs[k * LANES / 2..][..LANES / 2];
                u64x8::from_slice(self.simd, half).bitcast::<Floats<S>>()
            });
            low.deinterleave(high)
        };
        let ((h00, h10), (h01, h11)) = (columns(top), columns(bottom));
        [h00, h10, h01, h11]
    }
}
