use fearless_simd::prelude::*;

use super::axis::PacketAxis;
use super::beam;
use super::context::PacketContext;
use super::lanes::{Floats, Ints, LANES, Mask};
use super::pending::{PacketResult, PendingRay, PendingRays, ScalarRay};
use super::ray_packet::RayPacket;
use super::search::CellSearch;
use super::walk::PacketWalk;
use crate::{Ray, Record};

/// Rays whose packets look ahead together, one packet to a lane, and whose last ones are compacted into new packets.
const GROUP: usize = LANES * LANES;

/// The most cells of a packet that are solved before the rest is compacted.
const ROUNDS: u32 = 8;

/// The smallest map that is marched by packets: [`ROUNDS`] cells must not be a whole repeat.
pub(super) const MIN_SIZE: u32 = 2 * ROUNDS;

/// A packet with no more active rays than this is given up, for them to be compacted with others.
const MIN_ACTIVE: u32 = 4;

impl<S: Simd> PacketContext<'_, S> {
    /// Marches all rays, group by group; leaves some to be marched by themselves.
    #[inline(always)]
    pub(super) fn march_groups(&self, rays: &[Ray], records: &mut [Record], scalar_rays: &mut Vec<ScalarRay>) {
        let Some(&ray) = rays.first() else { return };
        let mut pending_rays = PendingRays { pending: Vec::with_capacity(GROUP + LANES), scalar: scalar_rays };
        let mut packets = [RayPacket::new(self, &[ray; LANES]); LANES];
        for start in (0..rays.len()).step_by(GROUP) {
            let group = &rays[start..rays.len().min(start + GROUP)];
            let (full, rest) = group.as_chunks();
            for (rays, packet) in full.iter().zip(&mut packets) {
                *packet = RayPacket::new(self, rays);
            }
            if let Some(last) = rest.len().checked_sub(1) {
                // The last one again, where a packet is not full.
                packets[full.len()] = RayPacket::new(self, &std::array::from_fn(|k| rest[k.min(last)]));
            }
            let packets = &packets[..group.len().div_ceil(LANES)];
            let entries = self.look_ahead(packets);
            for (p, packet) in packets.iter().enumerate() {
                let start = start + p * LANES;
                let result = self.march(packet, self.splat(entries[p]), Ints::splat(self.simd, 0));
                // Most have hit.
                for (lane, record) in records[start..].iter_mut().take(LANES).enumerate() {
                    *record = result.record(lane);
                }
                let mut others = !result.hit & (u64::MAX >> (64 - (rays.len() - start).min(LANES)));
                while others != 0 {
                    let lane = others.trailing_zeros() as usize;
                    let index = start + lane;
                    pending_rays.take(index, 0, lane, &result, &rays[index], &mut records[index]);
                    others &= others - 1;
                }
            }
            // Full packets only, until there are no more rays.
            let fewest = if start + GROUP < rays.len() { LANES } else { 1 };
            while pending_rays.pending.len() >= fewest {
                self.march_compacted(rays, records, &mut pending_rays);
            }
        }
    }

    /// Compacts the last pending rays into a packet, and marches them on.
    #[inline(always)]
    fn march_compacted(&self, rays: &[Ray], records: &mut [Record], pending_rays: &mut PendingRays<'_>) {
        let count = pending_rays.pending.len();
        let first = count.saturating_sub(LANES);
        let compacted: [PendingRay; LANES] = std::array::from_fn(|k| pending_rays.pending[(first + k).min(count - 1)]);
        pending_rays.pending.truncate(first);
        let from = Floats::load_array(self.simd, compacted.map(|ray| ray.depth));
        let cost = Ints::load_array(self.simd, compacted.map(|ray| ray.cost));
        let packet = RayPacket::new(self, &compacted.map(|ray| rays[ray.index]));
        let result = self.march(&packet, from, cost);
        for (lane, &PendingRay { index, compactions, .. }) in compacted.iter().enumerate().take(count - first) {
            if result.hit >> lane & 1 != 0 {
                records[index] = result.record(lane);
            } else {
                pending_rays.take(index, compactions, lane, &result, &rays[index], &mut records[index]);
            }
        }
    }

    /// Returns the depths down to which all rays of each of these packets are free.
    #[inline(always)]
    fn look_ahead(&self, packets: &[RayPacket<S>]) -> [f32; LANES] {
        self.simd.vectorize(
            #[inline(always)]
            || beam::look_ahead(self, packets),
        )
    }

    /// Marches rays on that are free down to the depths `from`, at the given cost until now.
    #[inline(always)]
    fn march(&self, packet: &RayPacket<S>, from: Floats<S>, cost: Ints<S>) -> PacketResult {
        // A function of its own, compiled once for both callers.
        self.simd.vectorize(
            #[inline(always)]
            || self.march_inlined(packet, from, cost),
        )
    }

    #[inline(always)]
    fn march_inlined(&self, packet: &RayPacket<S>, from: Floats<S>, cost: Ints<S>) -> PacketResult {
        let walk = self.walk(packet, from);
        let [u, v] = [packet.uv[0] + packet.slope[0] * walk.s, packet.uv[1] + packet.slope[1] * walk.s];
        let mut hit = walk.hit;
        if let Some(bounds) = self.options.bounds {
            hit &= u.simd_ge(bounds.min[0])
                & u.simd_le(bounds.max[0])
                & v.simd_ge(bounds.min[1])
                & v.simd_le(bounds.max[1]);
        }
        PacketResult {
            uv: [u.to_array(), v.to_array()],
            depth: walk.s.to_array(),
            cost: (walk.cost + cost).to_array(),
            hit: hit.to_bitmask(),
            active: walk.active.to_bitmask(),
            scalar: (!packet.usable).to_bitmask(),
        }
    }

    #[inline(always)]
    fn walk(&self, packet: &RayPacket<S>, from: Floats<S>) -> PacketWalk<S> {
        let simd = self.simd;
        let start = self.splat(self.lid);
        let none = Mask::splat(simd, false);
        let mut walk = PacketWalk {
            s: start.max(from.min(packet.end)),
            active: packet.usable,
            hit: none,
            cost: Ints::splat(simd, 0),
        };
        let search = CellSearch::new(self, packet, walk.s);
        let (mut x, mut y) = (PacketAxis::new(simd, packet, 0, start), PacketAxis::new(simd, packet, 1, start));
        let mut begun = none;
        for _ in 0..ROUNDS {
            let found = search.run(self, &mut walk, packet);
            let to = walk.s;
            let [entered_x, border_x] = x.jump(simd, to, start, begun, found);
            let [entered_y, border_y] = y.jump(simd, to, start, begun, found);
            let s = entered_x.max(entered_y);
            // On a tie the plain walk crosses columns first.
            let y_last = y.entered & (entered_y.simd_ge(entered_x) | !x.entered);
            x.entered &= !y_last;
            y.entered = y_last;
            let t_exit = border_y.simd_lt(border_x).select(border_y, border_x).max(s).min(packet.end);
            walk.cost -= found.to_vector();
            let inside = (search.direct & to.simd_lt(search.t_map_end) | !found).all_true();
            let cell = [(x.cell() + search.base[0]).to_int(), (y.cell() + search.base[1]).to_int()];
            let (met, at) = self.solve(&x, &y, cell, s, t_exit, found, inside);
            begun |= found;
            // The floor is a hit where nothing else was met; a border of the bounds is not.
            let ended = found & !met & t_exit.simd_ge(packet.end);
            walk.s = met.select(at, found.select(t_exit, walk.s));
            walk.hit |= met | (ended & t_exit.simd_eq(self.floor));
            walk.active &= !(met | ended);
            if walk.active.to_bitmask().count_ones() <= MIN_ACTIVE {
                break;
            }
        }
        walk
    }

    /// Intersects the `found` rays with the patches they are in, between `s` and `t_exit`: returns the rays that meet them, and
    /// the depths. Step by step as [`crate::patch::patch_crossing`].
    #[inline(always)]
    fn solve(
        &self,
        x: &PacketAxis<'_, S>,
        y: &PacketAxis<'_, S>,
        [column, row]: [Ints<S>; 2],
        s: Floats<S>,
        t_exit: Floats<S>,
        found: Mask<S>,
        inside: bool,
    ) -> (Mask<S>, Floats<S>) {
        let simd = self.simd;
        let [h00, h10, h01, h11] = self.corners(column, row, found, inside);
        let near = found & (-t_exit + 1.0).simd_le(h00.max(h10).max(h01.max(h11)));
        let (a, b) = (x.inside(simd, s), y.inside(simd, s));
        let (beta, gamma, kappa) = (h10 - h00, h01 - h00, h00 - h10 - h01 + h11);
        let c0 = (-s + 1.0) - (h00 + beta * a + gamma * b + kappa * a * b);
        let c1 = -(beta * *x.d + gamma * *y.d + kappa * (a * *y.d + b * *x.d)) - 1.0;
        let c2 = -kappa * *x.d * *y.d;
        let discriminant = c1 * c1 - c2 * 4.0 * c0;
        let q = (c1 + discriminant.sqrt().copysign(c1)) * -0.5;
        let length = t_exit - s;
        let infinity = Floats::splat(simd, f32::INFINITY);
        let (first, second) = (q / c2, c0 / q);
        // Comparisons with what is not a number are false: a negative discriminant has no root.
        let first = (first.simd_gt(0.0) & first.simd_le(length)).select(first, infinity);
        let second = (second.simd_gt(0.0) & second.simd_le(length)).select(second, infinity);
        let root = first.min(second);
        let below = c0.simd_le(0.0);
        let met = near & (below | root.simd_lt(infinity));
        (met, below.select(s, s + root))
    }
}
