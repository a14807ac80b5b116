//! The look-ahead of sixteen packets, each as one beam: the depth down to which all their rays are above the surface.

use fearless_simd::prelude::*;
use relievo_map::Wrap;

use super::context::PacketContext;
use super::lanes::{Floats, Ints, LANES, Mask};
use super::ray_packet::RayPacket;
use crate::pyramid::WindowGrid;

/// More steps than this are not worth their lookups.
const MAX_STEPS: u32 = 64;

/// The look-ahead ends when no more beams than this are active.
const MIN_ACTIVE: u32 = 2;

/// The least spread of a beam, in texels per unit of depth, so that one that goes straight down leaves its window too.
const SPREAD: f32 = 1e-4;

/// The extent of beams along one axis.
struct BeamSpan<S: Simd> {
    /// The trailing end is at `trail + trail_d·s`.
    trail: Floats<S>,
    trail_d: Floats<S>,
    /// The leading end crosses a border `e` at the depth `e·inv_d + offset`.
    inv_d: Floats<S>,
    offset: Floats<S>,
    /// Offsets from a beam's block to the border that it must not cross, in blocks, and to the block where its window begins.
    border_offset: Floats<S>,
    window_offset: Floats<S>,
    /// The depth at which the beams leave the map.
    end: Floats<S>,
    /// The beams that are in the map on the lid, and all of whose rays go in the same direction.
    usable: Mask<S>,
}

impl<S: Simd> BeamSpan<S> {
    /// Bounds beams by the lowest and highest positions of their rays, and the lowest and highest speeds per unit of depth.
    #[inline(always)]
    fn new(context: &PacketContext<'_, S>, k: usize, bounds: [[f32; LANES]; 4]) -> Self {
        let simd = context.simd;
        let splat = |x: f32| Floats::splat(simd, x);
        let [mut low, mut high, mut slowest, mut fastest] = bounds.map(|lanes| Floats::load_array(simd, lanes));
        let n = context.size[k] as f32;
        let lid = splat(context.lid);
        match context.map.wrap {
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
        let inv_d = splat(1.0) / up.select(fastest + SPREAD, slowest - SPREAD);
        let offset = -(lead * inv_d);
        Self {
            trail,
            trail_d,
            inv_d,
            offset,
            border_offset: up.select(splat(2.0), splat(-1.0)),
            window_offset: up.select(zero, splat(-1.0)),
            end: up.select(splat(n - 1.0), zero).mul_add(inv_d, offset),
            usable,
        }
    }
}

/// Returns the depths down to which all rays of each of these packets are free; that of the lid where nothing is known.
///
/// Every beam has its own window of 32×32, 8×8 or 4×4 cells, which begins with the block of half or a quarter of its width
/// that the last ray is in: so the beam goes on by a block at least, if it is not wider than the rest.
#[inline(always)]
pub(super) fn look_ahead<S: Simd>(context: &PacketContext<'_, S>, packets: &[RayPacket<S>]) -> [f32; LANES] {
    let simd = context.simd;
    let splat = |x: f32| Floats::splat(simd, x);
    let infinity = splat(f32::INFINITY);
    let mut bounds = [[[0.0; LANES]; 4]; 2];
    for (lane, packet) in packets.iter().enumerate().take(LANES) {
        let usable = packet.usable;
        for (k, bounds) in bounds.iter_mut().enumerate() {
            let (origin, d) = (packet.origin[k], packet.d[k]);
            bounds[0][lane] = usable.select(origin, infinity).reduce_min();
            bounds[1][lane] = usable.select(origin, -infinity).reduce_max();
            bounds[2][lane] = usable.select(d, infinity).reduce_min();
            bounds[3][lane] = usable.select(d, -infinity).reduce_max();
        }
    }
    let [x, y] = [BeamSpan::new(context, 0, bounds[0]), BeamSpan::new(context, 1, bounds[1])];
    let beams = Beams {
        stop: x.end.min(y.end).min(splat(context.floor)),
        usable: x.usable & y.usable,
        min_active: MIN_ACTIVE.min(packets.len() as u32 / 2),
        span: [x, y],
    };
    let windows = context.windows;
    let s = beams.descend(context, splat(context.lid), [windows.windows_32(), windows.windows_8()]);
    beams.descend(context, s, [windows.windows_8(), windows.windows_4()]).to_array()
}

/// The beams of sixteen packets.
struct Beams<S: Simd> {
    span: [BeamSpan<S>; 2],
    stop: Floats<S>,
    usable: Mask<S>,
    /// The descent ends when no more beams than this are active.
    min_active: u32,
}

impl<S: Simd> Beams<S> {
    /// Moves beams that are free down to `s` on by windows of two sizes; returns the depths they reach.
    #[inline(always)]
    fn descend(
        &self,
        context: &PacketContext<'_, S>,
        mut s: Floats<S>,
        [larger, smaller]: [WindowGrid; 2],
    ) -> Floats<S> {
        let simd = context.simd;
        let splat = |x: f32| Floats::splat(simd, x);
        let [x, y] = &self.span;
        let maxima = &context.windows.maxima()[smaller.start..];
        let first_larger = (larger.start - smaller.start) as i32;
        let widths = [larger, smaller].map(|windows| Ints::splat(simd, windows.size[0] as i32));
        let [large, small] = [larger, smaller].map(|windows| windows.pitch as f32);
        let mut active = self.usable & s.simd_lt(self.stop);
        // The larger block in whose window a beam is not free.
        let mut known = [splat(-1.0); 2];
        for _ in 0..MAX_STEPS {
            if active.to_bitmask().count_ones() <= self.min_active {
                break;
            }
            let (at_x, at_y) = (x.trail_d.mul_add(s, x.trail), y.trail_d.mul_add(s, y.trail));
            let (large_x, large_y) = ((at_x * (1.0 / large)).floor(), (at_y * (1.0 / large)).floor());
            let (small_x, small_y) = ((at_x * (1.0 / small)).floor(), (at_y * (1.0 / small)).floor());
            let new = large_x.simd_ne(known[0]) | large_y.simd_ne(known[1]);
            let (block_x, block_y) = (new.select(large_x, small_x), new.select(large_y, small_y));
            let scale = new.select(splat(large), splat(small));
            let exit_x = ((block_x + x.border_offset) * scale).mul_add(x.inv_d, x.offset);
            let exit_y = ((block_y + y.border_offset) * scale).mul_add(y.inv_d, y.offset);
            let t_exit = exit_x.min(exit_y).min(self.stop);
            let column = (block_x + x.window_offset).to_int::<Ints<S>>().max(0);
            let row = (block_y + y.window_offset).to_int::<Ints<S>>().max(0);
            let index = row * new.select(widths[0], widths[1]) + column + (new.to_vector() & first_larger);
            let down = context.look_up(maxima, index & active.to_vector());
            known = [new.select(large_x, known[0]), new.select(large_y, known[1])];
            // Beams that are wider than their window are past its end.
            let inside = t_exit.simd_gt(s);
            let free = inside & t_exit.simd_lt(down);
            s = (active & inside).select(t_exit.min(down).max(s), s);
            active &= (free & t_exit.simd_lt(self.stop)) | (new & !free);
        }
        s
    }
}
