//! The integral of a density that grows below a bilinear patch, along the part of a line in one cell: in closed form.

use crate::exact::VisitedCell;
use crate::grid_line::Line;
use crate::real::Real;

/// A line's depth below the patch of a cell, `g0 + g1·x + g2·x²` at the distance x in [0, length], cut where the density changes its
/// law: 0 above the surface, depth/softness down to the softness, 1 from there on.
pub(super) struct CellLayer<F> {
    depth: [F; 3],
    softness: F,
    /// Distances at which pieces begin and end; the first is 0, the last is the length.
    ends: [F; 6],
    pieces: usize,
}

impl<F: Real> CellLayer<F> {
    pub(super) fn new(cell: &VisitedCell<F>, line: &Line<F>, softness: F) -> Self {
        let depth = cell.clearance(line).map(|c| -c);
        let (zero, length) = (F::zero(), cell.t_exit - cell.s);
        let mut this = Self { depth, softness, ends: [zero, length, zero, zero, zero, zero], pieces: 1 };
        let [lowest, highest] = this.range(length);
        for level in [zero, softness] {
            // A cell that is wholly above, below or within the soft layer has no cuts.
            if lowest < level && level < highest {
                this.cut_at(level, length);
            }
        }
        this
    }

    /// Returns the depth below the surface.
    fn at(&self, x: F) -> F {
        let [g0, g1, g2] = self.depth;
        g0 + (g1 + g2 * x) * x
    }

    /// Returns the lowest and the highest depth up to this length.
    fn range(&self, length: F) -> [F; 2] {
        let (first, last) = (self.depth[0], self.at(length));
        let (lowest, highest) = (first.min(last), first.max(last));
        let vertex = -self.depth[1] / (self.depth[2] + self.depth[2]);
        // Also false for NaN: a straight line has no vertex.
        if vertex > F::zero() && vertex < length {
            let extremum = self.at(vertex);
            return [lowest.min(extremum), highest.max(extremum)];
        }
        [lowest, highest]
    }

    /// Cuts where the depth is this one.
    fn cut_at(&mut self, level: F, length: F) {
        let (half, four): (F, F) = (0.5.into(), 4.0.into());
        let [g0, g1, g2] = self.depth;
        let g0 = g0 - level;
        let discriminant = g1 * g1 - four * g2 * g0;
        if discriminant < F::zero() {
            return;
        }
        // The stable form: no cancellation.
        let q = -half * (g1 + g1.signum() * discriminant.sqrt());
        for x in [q / g2, g0 / q] {
            // Also false for NaN.
            if x > F::zero() && x < length {
                self.insert(x);
            }
        }
    }

    /// Puts a cut in its place between the ends.
    fn insert(&mut self, x: F) {
        let mut place = self.pieces + 1;
        while self.ends[place - 1] > x {
            self.ends[place] = self.ends[place - 1];
            place -= 1;
        }
        self.ends[place] = x;
        self.pieces += 1;
    }

    /// Returns the integral of the density from a to b, between which it follows one law.
    fn piece(&self, a: F, b: F) -> F {
        let (half, four, six): (F, F, F) = (0.5.into(), 4.0.into(), 6.0.into());
        let middle = self.at((a + b) * half);
        if middle <= F::zero() {
            return F::zero();
        }
        if middle >= self.softness {
            return b - a;
        }
        // Simpson's rule is exact for a parabola. Rounding must not bring the ends over the borders of the layer.
        let density = |x: F| (self.at(x) / self.softness).max(F::zero()).min(F::one());
        (b - a) * (density(a) + four * (middle / self.softness) + density(b)) / six
    }

    /// Returns the integral of the density over the cell.
    pub(super) fn integral(&self) -> F {
        (0..self.pieces).fold(F::zero(), |sum, k| sum + self.piece(self.ends[k], self.ends[k + 1]))
    }

    /// Returns the distance at which the integral from the entry on is this one: within a soft layer by four Newton steps.
    pub(super) fn distance_of(&self, integral: F) -> F {
        let mut rest = integral;
        for k in 0..self.pieces {
            let (a, b) = (self.ends[k], self.ends[k + 1]);
            let whole = self.piece(a, b);
            if whole < rest || whole <= F::zero() {
                rest = rest - whole;
                continue;
            }
            let mut x = a + (b - a) * (rest / whole);
            for _ in 0..4 {
                let density = (self.at(x) / self.softness).max(<F as From<f32>>::from(1e-3)).min(F::one());
                x = (x + (rest - self.piece(a, x)) / density).max(a).min(b);
            }
            return x;
        }
        self.ends[self.pieces]
    }
}
