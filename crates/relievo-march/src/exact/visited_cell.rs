use crate::grid_line::{Line, inside_cell};
use crate::patch::{clearance, patch_crossing};
use crate::real::Real;

/// A cell of the map with the part of a line that lies in it.
pub(crate) struct VisitedCell<F> {
    /// Heights h00, h10, h01, h11.
    pub(crate) corners: [F; 4],
    /// The line's lowest height in the cell.
    pub(crate) lowest: F,
    /// The position at which the line enters, and the cell, in texels from the base cell.
    pub(crate) entry: [F; 2],
    pub(crate) cell: [i32; 2],
    /// Texels per unit of s.
    pub(crate) d: [F; 2],
    /// The s at which the line enters and leaves.
    pub(crate) s: F,
    pub(crate) t_exit: F,
}

impl<F: Real> VisitedCell<F> {
    /// Returns true if the line passes above the cell's highest corner, and so above all of its patch.
    #[inline(always)]
    pub(crate) fn is_passed_above(&self) -> bool {
        let [h00, h10, h01, h11] = self.corners;
        // Written so that a number that is none is no pass.
        !(self.lowest <= h00.max(h10).max(h01.max(h11)))
    }

    /// Returns the entry in the cell, in [0, 1]².
    #[inline(always)]
    fn inside(&self) -> [F; 2] {
        [inside_cell(self.entry[0], self.cell[0]), inside_cell(self.entry[1], self.cell[1])]
    }

    /// Returns the distance beyond the entry at which the line is first on or below the patch.
    #[inline(always)]
    pub(crate) fn crossing(&self, line: &Line<F>) -> Option<F> {
        // Most cells need no more than this.
        if self.is_passed_above() {
            return None;
        }
        patch_crossing(self.corners, self.inside(), self.d, line, self.s, self.t_exit - self.s)
    }

    /// Returns the coefficients c0, c1, c2 of the line's height above the patch, c0 + c1·x + c2·x², x from the entry on.
    #[inline(always)]
    pub(crate) fn clearance(&self, line: &Line<F>) -> [F; 3] {
        clearance(self.corners, self.inside(), self.d, line, self.s)
    }
}
