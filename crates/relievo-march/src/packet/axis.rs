//! The rays of a packet along one axis, with the cell borders of the plain walk: [`crate::grid_line::GridLine`] in lanes.

use fearless_simd::prelude::*;

use super::lanes::{Floats, Mask};
use super::ray_packet::RayPacket;

/// The cells of a packet's rays along one axis.
pub(super) struct PacketAxis<'p, S: Simd> {
    pub(super) d: &'p Floats<S>,
    local: &'p Floats<S>,
    /// Depth per texel.
    inv_d: &'p Floats<S>,
    /// +1 or −1: the direction from border to border.
    step: Floats<S>,
    /// 1 where a ray leaves a cell by its upper border, 0 by the lower one, 2 where it never reaches one.
    border_offset: Floats<S>,
    /// The border by which the rays leave their cells, in cells from the line's start.
    edge: Floats<S>,
    /// The first such border, and the depth at which it is crossed.
    first: Floats<S>,
    t_at_first: Floats<S>,
    /// The rays that move along this axis at all.
    moving: Mask<S>,
    /// True if the ray came into its cell by the border behind, along this axis.
    pub(super) entered: Mask<S>,
}

impl<'p, S: Simd> PacketAxis<'p, S> {
    /// Places the rays at the depth `start`.
    #[inline(always)]
    pub(super) fn new(simd: S, packet: &'p RayPacket<S>, k: usize, start: Floats<S>) -> Self {
        let (d, local, inv_d) = (&packet.d[k], &packet.local[k], &packet.inv_d[k]);
        let up = d.simd_gt(0.0);
        let (zero, one) = (Floats::splat(simd, 0.0), Floats::splat(simd, 1.0));
        // Without movement no border is reached: it lies at a distance, and the inverse is infinite.
        let border_offset = up.select(one, d.simd_eq(0.0).select(one + one, zero));
        let edge = (*local + *d * start).floor() + border_offset;
        Self {
            d,
            local,
            inv_d,
            step: up.select(one, -one),
            border_offset,
            edge,
            first: edge,
            t_at_first: (edge - *local) * *inv_d,
            moving: d.simd_ne(0.0),
            entered: Mask::splat(simd, false),
        }
    }

    /// Returns the cells, counted from those of the line's start.
    #[inline(always)]
    pub(super) fn cell(&self) -> Floats<S> {
        self.edge - self.border_offset
    }

    /// Returns the depth at which this border is crossed.
    #[inline(always)]
    fn t_at_edge(&self, edge: Floats<S>) -> Floats<S> {
        (edge - *self.local) * *self.inv_d
    }

    /// Goes on to the cell of the depth `to`: the one between the borders that are crossed until then. Returns the depths at
    /// which the last of them is crossed, `start` if there is none, and at which the one after is. The first cell is the one
    /// of the position at `start`, and the second may begin there too; it does for rays that have `begun`. The result of rays
    /// other than `found` does not matter.
    #[inline(always)]
    pub(super) fn jump(
        &mut self,
        simd: S,
        to: Floats<S>,
        start: Floats<S>,
        begun: Mask<S>,
        found: Mask<S>,
    ) -> [Floats<S>; 2] {
        let zero = Floats::splat(simd, 0.0);
        let mut edge = (*self.local + *self.d * to).floor() + self.border_offset;
        let [mut behind, mut beyond] = [self.t_at_edge(edge - self.step), self.t_at_edge(edge)];
        // The position is rounded; the borders decide. They seldom differ.
        if ((behind.simd_gt(to) | beyond.simd_le(to)) & self.moving & found).any_true() {
            edge -= behind.simd_gt(to).select(self.step, zero);
            edge += self.t_at_edge(edge).simd_le(to).select(self.step, zero);
            [behind, beyond] = [self.t_at_edge(edge - self.step), self.t_at_edge(edge)];
        }
        self.entered = ((edge - self.first) * self.step).simd_gt(0.0) & self.moving & (to.simd_gt(start) | begun);
        self.edge = self.entered.select(edge, self.first);
        [self.entered.select(behind.max(start), start), self.entered.select(beyond, self.t_at_first)]
    }

    /// Returns the position inside its cell of each ray that came to it at the depth `s`, in [0, 1].
    #[inline(always)]
    pub(super) fn inside(&self, simd: S, s: Floats<S>) -> Floats<S> {
        let (zero, one) = (Floats::splat(simd, 0.0), Floats::splat(simd, 1.0));
        let position = (*self.local + *self.d * s) - (self.edge - self.border_offset);
        // Entered by a border: exactly there.
        self.entered.select(one - self.border_offset, position.max(zero).min(one))
    }
}
