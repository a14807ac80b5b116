//! Sixteen packets, each as one beam, look ahead: how deep all their rays go before the nearest can meet the surface.

use fearless_simd::prelude::*;
use relievo_map::Wrap;

use super::{Floats, Ints, LANES, Marcher, Mask, Packet};
use crate::pyramid::Windows;

/// More steps than this are not worth their lookups.
const MAX_STEPS: u32 = 64;

/// As few beams as this are not waited for.
const FEW: u32 = 2;

/// A beam is taken to get wider by this at least, in texels per unit of depth: what goes straight down leaves its window too.
const SPREAD: f32 = 1e-4;

/// Along one axis: where beams begin and end, and how they go.
struct Span<S: Simd> {
    /// The end that comes last is at `trail + trail_d·s`.
    trail: Floats<S>,
    trail_d: Floats<S>,
    /// The end that goes first crosses a border `e` at the depth `e·pace + offset`.
    pace: Floats<S>,
    offset: Floats<S>,
    /// From a beam's block to the border that it must not cross, in blocks, and to the block where its window begins.
    border: Floats<S>,
    window: Floats<S>,
    /// Where the map ends, in depth.
    end: Floats<S>,
    /// Those that are in the map on the lid, and all of whose rays go the same way.
    usable: Mask<S>,
}

impl<S: Simd> Span<S> {
    /// `bounds` are the lowest and highest positions, and the lowest and highest ways per unit of depth.
    #[inline(always)]
    fn new(marcher: &Marcher<'_, S>, k: usize, bounds: [[f32; LANES]; 4]) -> Self {
        let simd = marcher.simd;
        let splat = |x: f32| Floats::splat(simd, x);
        let [mut low, mut high, mut slowest, mut fastest] = bounds.map(|lanes| Floats::load_array(simd, lanes));
        let n = marcher.size[k] as f32;
        let lid = splat(marcher.lid);
        match marcher.map.wrap {
            Wrap::Repeat => {
                let tile = (slowest.mul_add(lid, low) * (1.0 / n)).floor() * n;
                (low, high) = (low - tile, high - tile);
            }
            Wrap::Clamp => {}
            Wrap::Mirror => {
                let tile = (slowest.mul_add(lid, low) * (0.5 / n)).floor() * (2.0 * n);
                (low, high) = (low - tile, high - tile);
                let mirrored = slowest.mul_add(lid, low).simd_ge(n);
                let last = splat(2.0 * n - 1.0);
                (low, high) = (mirrored.select(last - high, low), mirrored.select(last - low, high));
                (slowest, fastest) = (mirrored.select(-fastest, slowest), mirrored.select(-slowest, fastest));
            }
        }
        // Four times what rounding can move a ray.
        let reach = low.abs().max(high.abs()) + slowest.abs().max(fastest.abs());
        let margin = reach * (1.0 / (1 << 20) as f32);
        (low, high) = (low - margin, high + margin);
        let zero = splat(0.0);
        let up = slowest.simd_ge(zero);
        let usable = low.simd_le(high)
            & (up | fastest.simd_le(zero))
            & slowest.mul_add(lid, low).simd_ge(zero)
            & fastest.mul_add(lid, high).simd_le(splat(n - 1.0));
        let (trail, trail_d) = (up.select(low, high), up.select(slowest, fastest));
        let lead = up.select(high, low);
        let pace = splat(1.0) / up.select(fastest + SPREAD, slowest - SPREAD);
        let offset = -(lead * pace);
        Self {
            trail,
            trail_d,
            pace,
            offset,
            border: up.select(splat(2.0), splat(-1.0)),
            window: up.select(zero, splat(-1.0)),
            end: up.select(splat(n - 1.0), zero).mul_add(pace, offset),
            usable,
        }
    }
}

/// The depths down to which all rays of each of these packets are free; that of the lid where nothing is known.
///
/// Every beam has its own window of 32×32, 8×8 or 4×4 cells, which begins with the block of half or a quarter of its width
/// that the last ray is in: so the beam goes on by a block at least, if it is not wider than what is left.
#[inline(always)]
pub(super) fn look_ahead<S: Simd>(marcher: &Marcher<'_, S>, packets: &[Packet<S>]) -> [f32; LANES] {
    let simd = marcher.simd;
    let splat = |x: f32| Floats::splat(simd, x);
    let infinity = splat(f32::INFINITY);
    let mut bounds = [[[0.0; LANES]; 4]; 2];
    for (lane, packet) in packets.iter().enumerate().take(LANES) {
        let who = packet.together;
        for (k, bounds) in bounds.iter_mut().enumerate() {
            let (origin, d) = (packet.origin[k], packet.d[k]);
            bounds[0][lane] = who.select(origin, infinity).reduce_min();
            bounds[1][lane] = who.select(origin, -infinity).reduce_max();
            bounds[2][lane] = who.select(d, infinity).reduce_min();
            bounds[3][lane] = who.select(d, -infinity).reduce_max();
        }
    }
    let [x, y] = [Span::new(marcher, 0, bounds[0]), Span::new(marcher, 1, bounds[1])];
    let beams = Beams {
        stop: x.end.min(y.end).min(splat(marcher.floor)),
        usable: x.usable & y.usable,
        few: FEW.min(packets.len() as u32 / 2),
        span: [x, y],
    };
    let rows = marcher.rows;
    let s = beams.descend(marcher, splat(marcher.lid), [rows.large(), rows.small()]);
    beams.descend(marcher, s, [rows.small(), rows.fine()]).to_array()
}

/// What does not change on the way.
struct Beams<S: Simd> {
    span: [Span<S>; 2],
    stop: Floats<S>,
    usable: Mask<S>,
    /// As many are not waited for.
    few: u32,
}

impl<S: Simd> Beams<S> {
    /// How deep beams that are free down to `s` go on, by windows of two sizes.
    #[inline(always)]
    fn descend(&self, marcher: &Marcher<'_, S>, mut s: Floats<S>, [larger, smaller]: [Windows; 2]) -> Floats<S> {
        let simd = marcher.simd;
        let splat = |x: f32| Floats::splat(simd, x);
        let [x, y] = &self.span;
        let windows = &marcher.rows.windows()[smaller.start..];
        let first_larger = (larger.start - smaller.start) as i32;
        let widths = [larger, smaller].map(|windows| Ints::splat(simd, windows.size[0] as i32));
        let [large, small] = [larger, smaller].map(|windows| windows.pitch as f32);
        let mut active = self.usable & s.simd_lt(self.stop);
        // The larger block in whose window a beam is not free.
        let mut known = [splat(-1.0); 2];
        for _ in 0..MAX_STEPS {
            if active.to_bitmask().count_ones() <= self.few {
                break;
            }
            let (at_x, at_y) = (x.trail_d.mul_add(s, x.trail), y.trail_d.mul_add(s, y.trail));
            let (large_x, large_y) = ((at_x * (1.0 / large)).floor(), (at_y * (1.0 / large)).floor());
            let (small_x, small_y) = ((at_x * (1.0 / small)).floor(), (at_y * (1.0 / small)).floor());
            let new = large_x.simd_ne(known[0]) | large_y.simd_ne(known[1]);
            let (block_x, block_y) = (new.select(large_x, small_x), new.select(large_y, small_y));
            let scale = new.select(splat(large), splat(small));
            let next_x = ((block_x + x.border) * scale).mul_add(x.pace, x.offset);
            let next_y = ((block_y + y.border) * scale).mul_add(y.pace, y.offset);
            let leave = next_x.min(next_y).min(self.stop);
            let column = (block_x + x.window).to_int::<Ints<S>>().max(0);
            let row = (block_y + y.window).to_int::<Ints<S>>().max(0);
            let index = row * new.select(widths[0], widths[1]) + column + (new.to_vector() & first_larger);
            let down = marcher.look_up(windows, index & active.to_vector());
            known = [new.select(large_x, known[0]), new.select(large_y, known[1])];
            // Beams that are wider than their window are past its end.
            let inside = leave.simd_gt(s);
            let free = inside & leave.simd_lt(down);
            s = (active & inside).select(leave.min(down).max(s), s);
            active &= (free & leave.simd_lt(self.stop)) | (new & !free);
        }
        s
    }
}
