//! The search along the rays of a packet for cells that must be looked at.

use fearless_simd::prelude::*;
use relievo_map::Wrap;

use super::context::PacketContext;
use super::lanes::{Floats, Ints, Mask};
use super::ray_packet::RayPacket;
use super::walk::PacketWalk;

/// The most cells or windows that a packet looks up before the cells found are solved.
const MAX_LOOKUPS: u32 = 24;

/// The lookups from cell to cell before windows are tried.
const CELL_LOOKUPS: u32 = 6;

/// The most that a ray may sink when it is moved a little on into the cell that was found.
const MAX_NUDGE: f32 = 1.0 / 4096.0;

/// A search along the lines of rays, in the copy of the map that they are over.
///
/// It is rounded otherwise than the plain walk, and may be beside that walk's cells. It compares rays with the highest points
/// of cells with a margin for that; so rays above are free, in whichever cell.
pub(super) struct CellSearch<S: Simd> {
    /// The cells of the lines' starts, moved by whole repeats so that the rays are in the map.
    pub(super) base: [Floats<S>; 2],
    /// The position is `at + d·s`, moved a little on.
    at: [Floats<S>; 2],
    d: [Floats<S>; 2],
    /// The border by which rays leave cell `i` is crossed at the depth `i·inv_d + offset`.
    inv_d: [Floats<S>; 2],
    offset: [Floats<S>; 2],
    /// The least height above a cell's maximum at which a ray is surely above the surface.
    margin: Floats<S>,
    /// The depth at which rays leave the map, but for its last cells, which reach over its border.
    pub(super) t_map_end: Floats<S>,
    /// The distance by which rays are moved a little on, in depth.
    nudge: Floats<S>,
    /// The rays that are in the map now.
    inside: Mask<S>,
    /// The rays in the map whose lines are not mirrored.
    pub(super) direct: Mask<S>,
}

impl<S: Simd> CellSearch<S> {
    /// Prepares the search from the depths `s`.
    #[inline(always)]
    pub(super) fn new(context: &PacketContext<'_, S>, packet: &RayPacket<S>, s: Floats<S>) -> Self {
        let simd = context.simd;
        let splat = |x: f32| Floats::splat(simd, x);
        let (zero, infinity) = (splat(0.0), splat(f32::INFINITY));
        let mut base = [packet.origin[0].floor(), packet.origin[1].floor()];
        let mut direct = Mask::splat(simd, true);
        let (mut o, mut d, mut inv_d) = (packet.origin, packet.d, packet.inv_d);
        for k in 0..2 {
            let n = context.size[k] as f32;
            let at = o[k] + d[k] * s;
            match context.map.wrap {
                Wrap::Repeat => {
                    let tile = (at * (1.0 / n)).floor() * n;
                    base[k] -= tile;
                    o[k] -= tile;
                }
                Wrap::Clamp => {}
                Wrap::Mirror => {
                    let tile = (at * (0.5 / n)).floor() * (2.0 * n);
                    base[k] -= tile;
                    o[k] -= tile;
                    let mirrored = (at - tile).simd_ge(n);
                    direct &= !mirrored;
                    o[k] = mirrored.select(-o[k] + (2.0 * n - 1.0), o[k]);
                    d[k] = mirrored.select(-d[k], d[k]);
                    inv_d[k] = mirrored.select(-inv_d[k], inv_d[k]);
                }
            }
        }
        let mut t_map_end = infinity;
        let mut nudge = splat(MAX_NUDGE);
        let (mut at, mut offset, mut delta) = (o, o, o);
        let mut inside = Mask::splat(simd, true);
        for k in 0..2 {
            // Rounding moves positions and borders hardly more than this, fused or not.
            delta[k] = (o[k].abs() + d[k].abs()) * (1.0 / (1 << 22) as f32);
            // Into the cell that follows, where a ray is at a border.
            at[k] = o[k] + delta[k].copysign(d[k]);
            let flat = d[k].simd_eq(0.0);
            let up = d[k].simd_gt(0.0);
            nudge = nudge.min(flat.select(infinity, delta[k] * inv_d[k].abs()));
            inv_d[k] = flat.select(zero, inv_d[k]);
            let start = flat.select(infinity, -(o[k] * inv_d[k]));
            offset[k] = start + up.select(inv_d[k], zero);
            let margin = delta[k] * 2.0;
            let end = -margin + (context.size[k] - 1) as f32;
            t_map_end = t_map_end.min(up.select(end, margin).mul_add(inv_d[k], start));
            let here = o[k] + d[k] * s;
            inside &= here.simd_ge(margin) & here.simd_le(end);
        }
        // A ray that is taken to be in a cell may be twice that far beside it, and the surface there so much higher: it is
        // continuous, and climbs no more than this in a texel, along each axis. A quarter more, to be on the safe side.
        let climb = (delta[0] + delta[1]) * (2.5 * context.steepest);
        let margin = climb + nudge;
        Self { base, at, d, inv_d, offset, margin, t_map_end, nudge, inside, direct: direct & inside }
    }

    /// Moves active rays on as far as they are free; returns the rays that came to a cell that must be looked at.
    #[inline(always)]
    pub(super) fn run(
        &self,
        context: &PacketContext<'_, S>,
        walk: &mut PacketWalk<S>,
        packet: &RayPacket<S>,
    ) -> Mask<S> {
        let stop = packet.end.min(self.t_map_end);
        let mut active = walk.active & self.inside & walk.s.simd_lt(stop);
        let min_active = walk.active.to_bitmask().count_ones() / 4;
        let (mut s, mut cells) = (walk.s, CELL_LOOKUPS);
        for _ in 0..MAX_LOOKUPS {
            let count = active.to_bitmask().count_ones();
            if count <= min_active {
                break;
            }
            walk.cost -= active.to_vector();
            let by_windows = cells == 0;
            let [t_exit, above] =
                if by_windows { self.window(context, s, active) } else { self.cell(context, s, active) };
            // All are free down to the highest point of the cell or window.
            let down = (above - self.margin).min(stop);
            let free = t_exit.simd_lt(down);
            s = active.select(t_exit.min(down).max(s), s);
            if by_windows {
                active &= s.simd_lt(stop);
                if (active & free).to_bitmask().count_ones() * 2 < count {
                    cells = CELL_LOOKUPS;
                }
            } else {
                active &= free;
                cells -= 1;
            }
        }
        // Moved a little on, so that the cell found is entered; but not where the last patch was left just now: nothing may be
        // left out.
        let found = s.simd_gt(walk.s) & !active;
        walk.s = found.select(s + self.nudge, s).min(packet.end);
        walk.active & !active
    }

    /// Returns the depths at which rays leave the cells they are in, and down to which they are above these.
    #[inline(always)]
    fn cell(&self, context: &PacketContext<'_, S>, s: Floats<S>, active: Mask<S>) -> [Floats<S>; 2] {
        let x = self.d[0].mul_add(s, self.at[0]).floor();
        let y = self.d[1].mul_add(s, self.at[1]).floor();
        let t_exit = x.mul_add(self.inv_d[0], self.offset[0]).min(y.mul_add(self.inv_d[1], self.offset[1]));
        let index = y.to_int::<Ints<S>>() * context.size[0] + x.to_int::<Ints<S>>();
        [t_exit, context.look_up(context.windows.cells(), index & active.to_vector())]
    }

    /// Returns the depths at which rays leave the windows of 8×8 cells that begin with the blocks of 4×4 they are in, and down
    /// to which they are above these.
    #[inline(always)]
    fn window(&self, context: &PacketContext<'_, S>, s: Floats<S>, active: Mask<S>) -> [Floats<S>; 2] {
        let windows = context.windows.windows_8();
        let [(exit_x, x), (exit_y, y)] = [self.window_along(0, context.simd, s), self.window_along(1, context.simd, s)];
        let index = y * windows.size[0] as i32 + x;
        let maxima = &context.windows.maxima()[windows.start..];
        [exit_x.min(exit_y), context.look_up(maxima, index & active.to_vector())]
    }

    /// Returns the depths at which rays leave their windows along one axis, and the indices of these.
    #[inline(always)]
    fn window_along(&self, k: usize, simd: S, s: Floats<S>) -> (Floats<S>, Ints<S>) {
        let splat = |x: f32| Floats::splat(simd, x);
        let block = (self.d[k].mul_add(s, self.at[k]) * 0.25).floor();
        let up = self.d[k].simd_gt(0.0);
        // The last cell of the window.
        let cell = block.mul_add(splat(4.0), up.select(splat(7.0), splat(-4.0)));
        (cell.mul_add(self.inv_d[k], self.offset[k]), (block.to_int::<Ints<S>>() + (!up).to_vector()).max(0))
    }
}
