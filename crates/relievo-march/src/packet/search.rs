//! The search along sixteen rays for cells that must be looked at.

use fearless_simd::prelude::*;
use relievo_map::Wrap;

use super::{Floats, Ints, Marcher, Mask, Packet, SEARCH, Walk};
use crate::pyramid::BITS;

/// How far a ray may sink while it goes a little on into the cell that was found, in codes.
const MOST_ON: f32 = 1.0 / 16.0;

/// What the search along rays needs: their lines in the map as it stands where they are.
///
/// It is rounded otherwise than the plain walk, and may be beside the cells that this one goes through. It looks up whether
/// rays are above the highest points of blocks by more than that can matter; so they are free, in whichever cell.
pub(super) struct Search<S: Simd> {
    /// The cells of the lines' starts, so many whole repeats on that the rays are in the map.
    pub(super) base: [Ints<S>; 2],
    /// The position is `at + d·s`, a little on.
    at: [Floats<S>; 2],
    d: [Floats<S>; 2],
    /// A border `e` is crossed at the depth `e·pace + offset`.
    pace: [Floats<S>; 2],
    offset: [Floats<S>; 2],
    ahead: [Floats<S>; 2],
    /// A ray's height in codes at depth 0, with the margins off.
    code: Floats<S>,
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
        let (zero, one, infinity) = (splat(0.0), splat(1.0), splat(f32::INFINITY));
        let mut base = packet.base;
        let mut direct = Mask::splat(simd, true);
        let (mut o, mut d, mut pace) = (packet.origin, packet.d, packet.pace);
        for k in 0..2 {
            let n = marcher.size[k] as f32;
            let at = o[k] + d[k] * s;
            match marcher.map.wrap {
                Wrap::Repeat => {
                    let tile = (at * (1.0 / n)).floor() * n;
                    base[k] -= tile.to_int::<Ints<S>>();
                    o[k] -= tile;
                }
                Wrap::Clamp => {}
                Wrap::Mirror => {
                    let tile = (at * (0.5 / n)).floor() * (2.0 * n);
                    base[k] -= tile.to_int::<Ints<S>>();
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
        let mut on = splat(-MOST_ON / marcher.code_rise);
        let (mut at, mut offset, mut ahead, mut delta) = (o, o, o, o);
        let mut inside = Mask::splat(simd, true);
        for k in 0..2 {
            // Rounding moves positions and borders hardly more than this, fused or not.
            delta[k] = (o[k].abs() + d[k].abs()) * (1.0 / (1 << 22) as f32);
            // In the block ahead, where a ray is at a border.
            at[k] = o[k] + delta[k].copysign(d[k]);
            let flat = d[k].simd_eq(0.0);
            let up = d[k].simd_gt(0.0);
            on = on.min(flat.select(infinity, delta[k] * pace[k].abs()));
            pace[k] = flat.select(zero, pace[k]);
            offset[k] = flat.select(infinity, -(o[k] * pace[k]));
            ahead[k] = up.select(one, zero);
            let margin = delta[k] * 2.0;
            let end = -margin + (marcher.size[k] - 1) as f32;
            border = border.min(up.select(end, margin).mul_add(pace[k], offset[k]));
            let here = o[k] + d[k] * s;
            inside &= here.simd_ge(margin) & here.simd_le(end);
        }
        // A ray that is believed to be in a block may be twice that far beside it, and the surface there so much higher: it
        // is continuous, and climbs 255 codes in a texel at most, along each axis. A quarter more, to be on the safe side.
        let code = -((delta[0] + delta[1]) * 640.0) + (marcher.code - MOST_ON);
        Self { base, at, d, pace, offset, ahead, code, border, on, inside, direct: direct & inside }
    }

    /// How far down those that walk are free; gives those that came to a cell that must be looked at.
    #[inline(always)]
    pub(super) fn run(&self, marcher: &Marcher<'_, S>, walk: &mut Walk<S>, packet: &Packet<S>) -> Mask<S> {
        let simd = marcher.simd;
        let splat = |x: f32| Floats::splat(simd, x);
        let stop = packet.end.min(self.border);
        let mut active = walk.walking & self.inside & walk.s.simd_lt(stop);
        let few = walk.walking.to_bitmask().count_ones() / 4;
        let mut coarse = Mask::splat(simd, false);
        let (one, four, quarter) = (splat(1.0), splat(4.0), splat(0.25));
        let pitches = marcher.nodes.map(|n| Ints::splat(simd, 16 * n - 16));
        let mut s = walk.s;
        for _ in 0..SEARCH {
            if active.to_bitmask().count_ones() <= few {
                break;
            }
            walk.cost -= active.to_vector();
            let (scale, per) = (coarse.select(four, one), coarse.select(quarter, one));
            let x = (self.d[0].mul_add(s, self.at[0]) * per).floor();
            let y = (self.d[1].mul_add(s, self.at[1]) * per).floor();
            let (edge_x, edge_y) = ((x + self.ahead[0]) * scale, (y + self.ahead[1]) * scale);
            let next_x = edge_x.mul_add(self.pace[0], self.offset[0]);
            let next_y = edge_y.mul_add(self.pace[1], self.offset[1]);
            let leave = next_x.min(next_y).min(stop).max(s);
            let (x, y) = (x.to_int::<Ints<S>>(), y.to_int::<Ints<S>>());
            let second = coarse.to_vector() & marcher.second;
            let index =
                (y >> BITS) * coarse.select(pitches[1], pitches[0]) + (x >> BITS) * 12 + (y << BITS) + x + second;
            let highest = marcher.highest(index & active.to_vector());
            let near = leave.mul_add(splat(marcher.code_rise), self.code).simd_le(highest);
            let free = active & !near;
            let edge = next_y.simd_lt(next_x).select(edge_y, edge_x) * quarter;
            active &= (free & leave.simd_lt(stop)) | (near & coarse);
            s = free.select(leave, s);
            coarse = free & (coarse | edge.floor().simd_eq(edge));
        }
        // A little on, so that the cell found is entered; but where the last patch was left just now, nothing may be left out.
        let found = s.simd_gt(walk.s) & !active;
        walk.s = found.select(s + self.on, s).min(packet.end);
        walk.walking & !active
    }
}
