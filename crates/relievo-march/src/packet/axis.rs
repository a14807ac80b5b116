//! Sixteen rays along one axis, with the borders of cells as the plain walk has them.

use fearless_simd::prelude::*;

use super::{Floats, Mask, Packet};

/// Along one axis: where rays are, and how they go on.
pub(super) struct Axis<'p, S: Simd> {
    pub(super) d: &'p Floats<S>,
    local: &'p Floats<S>,
    /// Depth per texel.
    pace: &'p Floats<S>,
    /// 1 or −1: the way from border to border.
    stride: Floats<S>,
    /// 1 where the border ahead is the cell's upper one, 0 where it is the lower one, 2 where none is ever reached.
    ahead: Floats<S>,
    /// The border ahead, in cells from that of the line's start.
    edge: Floats<S>,
    /// The first one, and the depth at which it is crossed.
    first: Floats<S>,
    first_crossing: Floats<S>,
    /// Those that go along this axis at all.
    moving: Mask<S>,
    /// Whether the border behind was the last to be crossed.
    pub(super) entered: Mask<S>,
}

impl<'p, S: Simd> Axis<'p, S> {
    /// Where the rays are at the depth `start`.
    #[inline(always)]
    pub(super) fn new(simd: S, packet: &'p Packet<S>, k: usize, start: Floats<S>) -> Self {
        let (d, local, pace) = (&packet.d[k], &packet.local[k], &packet.pace[k]);
        let up = d.simd_gt(0.0);
        let (zero, one) = (Floats::splat(simd, 0.0), Floats::splat(simd, 1.0));
        // No border is reached: it is more than nothing ahead, and the pace is infinite.
        let ahead = up.select(one, d.simd_eq(0.0).select(one + one, zero));
        let edge = (*local + *d * start).floor() + ahead;
        Self {
            d,
            local,
            pace,
            stride: up.select(one, -one),
            ahead,
            edge,
            first: edge,
            first_crossing: (edge - *local) * *pace,
            moving: d.simd_ne(0.0),
            entered: Mask::splat(simd, false),
        }
    }

    /// The cells, counted from those of the line's start.
    #[inline(always)]
    pub(super) fn cell(&self) -> Floats<S> {
        self.edge - self.ahead
    }

    /// The depth at which this border is crossed.
    #[inline(always)]
    fn crossing(&self, edge: Floats<S>) -> Floats<S> {
        (edge - *self.local) * *self.pace
    }

    /// On to the cell of the depth `to`: the one between the borders that are crossed until then. Gives the depths at which
    /// the last of them is crossed, `start` if there is none, and at which the next one is. The first cell is the one of the
    /// position at `start`, and the next may begin there too; so it does for those that have `begun`. What becomes of others
    /// than `who` does not matter.
    #[inline(always)]
    pub(super) fn jump(
        &mut self,
        simd: S,
        to: Floats<S>,
        start: Floats<S>,
        begun: Mask<S>,
        who: Mask<S>,
    ) -> [Floats<S>; 2] {
        let zero = Floats::splat(simd, 0.0);
        let mut edge = (*self.local + *self.d * to).floor() + self.ahead;
        let [mut behind, mut beyond] = [self.crossing(edge - self.stride), self.crossing(edge)];
        // The position is rounded; the borders tell. They seldom tell something else.
        if ((behind.simd_gt(to) | beyond.simd_le(to)) & self.moving & who).any_true() {
            edge -= behind.simd_gt(to).select(self.stride, zero);
            edge += self.crossing(edge).simd_le(to).select(self.stride, zero);
            [behind, beyond] = [self.crossing(edge - self.stride), self.crossing(edge)];
        }
        self.entered = ((edge - self.first) * self.stride).simd_gt(0.0) & self.moving & (to.simd_gt(start) | begun);
        self.edge = self.entered.select(edge, self.first);
        [self.entered.select(behind.max(start), start), self.entered.select(beyond, self.first_crossing)]
    }

    /// How far inside its cell each ray is that came to it at the depth `s`.
    #[inline(always)]
    pub(super) fn inside(&self, simd: S, s: Floats<S>) -> Floats<S> {
        let (zero, one) = (Floats::splat(simd, 0.0), Floats::splat(simd, 1.0));
        let position = (*self.local + *self.d * s) - (self.edge - self.ahead);
        // By a border: exactly there.
        self.entered.select(one - self.ahead, position.max(zero).min(one))
    }
}
