//! The search along sixteen rays for cells that must be looked at.

use fearless_simd::prelude::*;
use relievo_map::Wrap;

use super::{Floats, Ints, Marcher, Mask, Packet, Walk};

/// A packet looks up so many cells or windows at most before the cells found are solved.
const TURNS: u32 = 24;

/// So many turns go from cell to cell before windows are tried.
const CELLS: u32 = 6;

/// How far a ray may sink while it goes a little on into the cell that was found.
const MOST_ON: f32 = 1.0 / 4096.0;

/// What the search along rays needs: their lines in the map as it stands where they are.
///
/// It is rounded otherwise than the plain walk, and may be beside the cells that this one goes through. It looks up whether
/// rays are above the highest points of cells by more than that can matter; so they are free, in whichever cell.
pub(super) struct Search<S: Simd> {
    /// The cells of the lines' starts, so many whole repeats on that the rays are in the map.
    pub(super) base: [Floats<S>; 2],
    /// The position is `at + d·s`, a little on.
    at: [Floats<S>; 2],
    d: [Floats<S>; 2],
    /// The border ahead of cell `i` is crossed at the depth `i·pace + offset`.
    pace: [Floats<S>; 2],
    offset: [Floats<S>; 2],
    /// How far above the surface a ray must be, to be believed so.
    margin: Floats<S>,
    /// Where the map ends, but for its last cells, which reach over its border.
    pub(super) border: Floats<S>,
    /// A little way on, in depth.
    on: Floats<S>,
    /// Those that are in the map now.
    inside: Mask<S>,
    /// Those whose lines are not mirrored, too.
    pub(super) direct: Mask<S>,
}

impl<S: Simd> Search<S> {
    /// `s` tells where the rays are.
    #[inline(always)]
    pub(super) fn new(marcher: &Marcher<'_, S>, packet: &Packet<S>, s: Floats<S>) -> Self {
        let simd = marcher.simd;
        let splat = |x: f32| Floats::splat(simd, x);
        let (zero, infinity) = (splat(0.0), splat(f32::INFINITY));
        let mut base = [packet.origin[0].floor(), packet.origin[1].floor()];
        let mut direct = Mask::splat(simd, true);
        let (mut o, mut d, mut pace) = (packet.origin, packet.d, packet.pace);
        for k in 0..2 {
            let n = marcher.size[k] as f32;
            let at = o[k] + d[k] * s;
            match marcher.map.wrap {
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
                    pace[k] = mirrored.select(-pace[k], pace[k]);
                }
            }
        }
        let mut border = infinity;
        let mut on = splat(MOST_ON);
        let (mut at, mut offset, mut delta) = (o, o, o);
        let mut inside = Mask::splat(simd, true);
        for k in 0..2 {
            // Rounding moves positions and borders hardly more than this, fused or not.
            delta[k] = (o[k].abs() + d[k].abs()) * (1.0 / (1 << 22) as f32);
            // In the cell ahead, where a ray is at a border.
            at[k] = o[k] + delta[k].copysign(d[k]);
            let flat = d[k].simd_eq(0.0);
            let up = d[k].simd_gt(0.0);
            on = on.min(flat.select(infinity, delta[k] * pace[k].abs()));
            pace[k] = flat.select(zero, pace[k]);
            let start = flat.select(infinity, -(o[k] * pace[k]));
            offset[k] = start + up.select(pace[k], zero);
            let margin = delta[k] * 2.0;
            let end = -margin + (marcher.size[k] - 1) as f32;
            border = border.min(up.select(end, margin).mul_add(pace[k], start));
            let here = o[k] + d[k] * s;
            inside &= here.simd_ge(margin) & here.simd_le(end);
        }
        // A ray that is believed to be in a cell may be twice that far beside it, and the surface there so much higher: it
        // is continuous, and climbs no more than this in a texel, along each axis. A quarter more, to be on the safe side.
        let climb = (delta[0] + delta[1]) * (2.5 * marcher.steepest);
        let margin = climb + on;
        Self { base, at, d, pace, offset, margin, border, on, inside, direct: direct & inside }
    }

    /// How far down those that walk are free; gives those that came to a cell that must be looked at.
    #[inline(always)]
    pub(super) fn run(&self, marcher: &Marcher<'_, S>, walk: &mut Walk<S>, packet: &Packet<S>) -> Mask<S> {
        let stop = packet.end.min(self.border);
        let mut active = walk.walking & self.inside & walk.s.simd_lt(stop);
        let few = walk.walking.to_bitmask().count_ones() / 4;
        let (mut s, mut cells) = (walk.s, CELLS);
        for _ in 0..TURNS {
            let count = active.to_bitmask().count_ones();
            if count <= few {
                break;
            }
            walk.cost -= active.to_vector();
            let by_windows = cells == 0;
            let [leave, above] =
                if by_windows { self.window(marcher, s, active) } else { self.cell(marcher, s, active) };
            // All are free down to the highest point there.
            let down = (above - self.margin).min(stop);
            let free = leave.simd_lt(down);
            s = active.select(leave.min(down).max(s), s);
            if by_windows {
                active &= s.simd_lt(stop);
                if (active & free).to_bitmask().count_ones() * 2 < count {
                    cells = CELLS;
                }
            } else {
                active &= free;
                cells -= 1;
            }
        }
        // A little on, so that the cell found is entered; but where the last patch was left just now, nothing may be left out.
        let found = s.simd_gt(walk.s) & !active;
        walk.s = found.select(s + self.on, s).min(packet.end);
        walk.walking & !active
    }

    /// Where rays leave the cells they are in, and down to which depths they are above these.
    #[inline(always)]
    fn cell(&self, marcher: &Marcher<'_, S>, s: Floats<S>, active: Mask<S>) -> [Floats<S>; 2] {
        let x = self.d[0].mul_add(s, self.at[0]).floor();
        let y = self.d[1].mul_add(s, self.at[1]).floor();
        let leave = x.mul_add(self.pace[0], self.offset[0]).min(y.mul_add(self.pace[1], self.offset[1]));
        let index = y.to_int::<Ints<S>>() * marcher.size[0] + x.to_int::<Ints<S>>();
        [leave, marcher.look_up(marcher.rows.cells(), index & active.to_vector())]
    }

    /// Where rays leave the windows of 8×8 cells that begin with the blocks of 4×4 they are in, and down to which depths
    /// they are above these.
    #[inline(always)]
    fn window(&self, marcher: &Marcher<'_, S>, s: Floats<S>, active: Mask<S>) -> [Floats<S>; 2] {
        let windows = marcher.rows.small();
        let [(leave_x, x), (leave_y, y)] =
            [self.window_along(0, marcher.simd, s), self.window_along(1, marcher.simd, s)];
        let index = y * windows.size[0] as i32 + x;
        let codes = &marcher.rows.windows()[windows.start..];
        [leave_x.min(leave_y), marcher.look_up(codes, index & active.to_vector())]
    }

    /// Along one axis: where rays leave their windows, and the numbers of these.
    #[inline(always)]
    fn window_along(&self, k: usize, simd: S, s: Floats<S>) -> (Floats<S>, Ints<S>) {
        let splat = |x: f32| Floats::splat(simd, x);
        let block = (self.d[k].mul_add(s, self.at[k]) * 0.25).floor();
        let up = self.d[k].simd_gt(0.0);
        // The cell whose border ahead is that of the window.
        let cell = block.mul_add(splat(4.0), up.select(splat(7.0), splat(-4.0)));
        (cell.mul_add(self.pace[k], self.offset[k]), (block.to_int::<Ints<S>>() + (!up).to_vector()).max(0))
    }
}
