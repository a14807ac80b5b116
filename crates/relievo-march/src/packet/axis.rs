//! Sixteen rays along one axis, with the borders of cells as the plain walk has them.

use fearless_simd::prelude::*;

use super::{Floats, Ints, Mask, Packet};

/// Along one axis: where rays are, and how they go on.
pub(super) struct Axis<S: Simd> {
    pub(super) d: Floats<S>,
    local: Floats<S>,
    /// Depth per texel.
    pace: Floats<S>,
    /// 1 or −1: the way from border to border.
    stride: Floats<S>,
    /// 1 where the border ahead is the cell's upper one, 0 where it is the lower one, 2 where none is ever reached.
    ahead: Floats<S>,
    /// The border ahead, in cells from that of the line's start.
    edge: Floats<S>,
    /// The first one.
    first: Floats<S>,
    /// Whether the border behind was the last to be crossed.
    pub(super) entered: Mask<S>,
}

impl<S: Simd> Axis<S> {
    /// Where the rays are at the depth `start`.
    #[inline(always)]
    pub(super) fn new(simd: S, packet: &Packet<S>, k: usize, start: Floats<S>) -> Self {
        let (d, local) = (packet.d[k], packet.local[k]);
        let up = d.simd_gt(0.0);
        let (zero, one) = (Floats::splat(simd, 0.0), Floats::splat(simd, 1.0));
        // No border is reached: it is more than nothing ahead, and the pace is infinite.
        let ahead = up.select(one, d.simd_eq(0.0).select(one + one, zero));
        let edge = (local + d * start).floor() + ahead;
        Self {
            d,
            local,
            pace: packet.pace[k],
            stride: up.select(one, -one),
            ahead,
            edge,
            first: edge,
            entered: Mask::splat(simd, false),
        }
    }

    /// The cells, counted from those of the line's start.
    #[inline(always)]
    pub(super) fn cell(&self) -> Ints<S> {
        (self.edge - self.ahead).to_int()
    }

    /// The depth at which the border ahead is crossed.
    #[inline(always)]
    pub(super) fn next(&self) -> Floats<S> {
        self.crossing(self.edge)
    }

    /// The depth at which this border is crossed.
    #[inline(always)]
    fn crossing(&self, edge: Floats<S>) -> Floats<S> {
        (edge - self.local) * self.pace
    }

    /// On to the cell of the depth `to`: the one between the borders that are crossed until then. Gives the depth at which the
    /// last of them is crossed, `start` if there is none. The first cell is the one of the position at `start`, and the next
    /// may begin there too; so it does for those that have `begun`.
    #[inline(always)]
    pub(super) fn jump(&mut self, simd: S, to: Floats<S>, start: Floats<S>, begun: Mask<S>) -> Floats<S> {
        let zero = Floats::splat(simd, 0.0);
        let guess = (self.local + self.d * to).floor() + self.ahead;
        // The position is rounded; the borders tell.
        let too_far = self.crossing(guess - self.stride).simd_gt(to);
        let edge = guess - too_far.select(self.stride, zero);
        let not_yet = self.crossing(edge).simd_le(to);
        let edge = edge + not_yet.select(self.stride, zero);
        self.entered =
            ((edge - self.first) * self.stride).simd_gt(0.0) & self.d.simd_ne(0.0) & (to.simd_gt(start) | begun);
        self.edge = self.entered.select(edge, self.first);
        self.entered.select(self.crossing(self.edge - self.stride).max(start), start)
    }

    /// How far inside its cell each ray is that came to it at the depth `s`.
    #[inline(always)]
    pub(super) fn inside(&self, simd: S, s: Floats<S>) -> Floats<S> {
        let (zero, one) = (Floats::splat(simd, 0.0), Floats::splat(simd, 1.0));
        let position = (self.local + self.d * s) - (self.edge - self.ahead);
        // By a border: exactly there.
        self.entered.select(one - self.ahead, position.max(zero).min(one))
    }
}
