//! The plain walk, cell by cell (Amanatides and Woo 1987): the oracle's, that of fields without a pyramid, and the reference
//! that the marches through pyramids and cones must agree with.

use super::crossing::SurfaceCrossing;
use super::visited_cell::VisitedCell;
use crate::HeightField;
use crate::cost::MarchCost;
use crate::grid_line::{GridLine, Line};
use crate::real::Real;

/// The distance beyond the border of a column at which its wall is met, in texels.
const BESIDE_WALL: f32 = 1e-3;

/// The part of the full depth that such a hit goes on at most, where a ray falls steeply along the wall.
const MOST_DEEPER: f32 = 1e-3;

/// Walks over the cells from `start` to the first s at which the line is on or below the surface, at most to `end`; returns
/// the cost too.
pub(crate) fn walk_cells<F: Real>(
    field: &impl HeightField,
    line: &Line<F>,
    start: F,
    end: F,
    max_cells: u32,
) -> (SurfaceCrossing<F>, MarchCost) {
    let has_columns = field.texel_offset() == 0.0;
    visit_cells(field, line, start, end, max_cells, |cell| {
        let mut x = cell.crossing(line)?;
        if has_columns && x == F::zero() && line.height + line.dheight_ds * cell.s < cell.corners[0] {
            // The wall of a column: a hair beyond its border, so that uv shows the column, whatever rounding does.
            let speed = cell.d[0].abs().max(cell.d[1].abs());
            let [beside, deeper] = [BESIDE_WALL, MOST_DEEPER].map(<F as From<f32>>::from);
            x = (beside / speed).min(deeper).min(cell.t_exit - cell.s);
        }
        Some(cell.s + x)
    })
}

/// Calls `visit` with every cell from `start` to `end` until it returns an s.
#[inline(always)]
pub(crate) fn visit_cells<F: Real>(
    field: &impl HeightField,
    line: &Line<F>,
    start: F,
    end: F,
    max_cells: u32,
    mut visit: impl FnMut(&VisitedCell<F>) -> Option<F>,
) -> (SurfaceCrossing<F>, MarchCost) {
    let cost = |cells| MarchCost { fetches: cells, gathers: cells, iterations: cells };
    let grid = GridLine::new(field.size(), field.texel_offset(), line);
    let mut cell = grid.position(start).map(Real::floor_int);
    let mut t_at_border = [grid.t_at_border(cell[0], 0), grid.t_at_border(cell[1], 1)];
    let mut s = start;
    let mut entry = grid.position(s);
    let mut cells = 0;
    loop {
        cells += 1;
        let axis = usize::from(t_at_border[1] < t_at_border[0]);
        let t_exit = t_at_border[axis].max(s).min(end);
        let [i, j] = grid.map_cell(cell);
        let corners = field.corners(i, j).map(<F as From<f32>>::from);
        let lowest = line.height + line.dheight_ds * (if line.dheight_ds < F::zero() { t_exit } else { s });
        if let Some(found) = visit(&VisitedCell { corners, lowest, entry, cell, d: grid.d, s, t_exit }) {
            return (SurfaceCrossing::At(found), cost(cells));
        }
        if t_exit >= end {
            return (SurfaceCrossing::None, cost(cells));
        }
        if cells >= max_cells {
            return (SurfaceCrossing::CutOff(t_exit), cost(cells));
        }
        s = t_exit;
        entry = grid.position(s);
        // The line crosses this border exactly; rounding must not put it beside.
        entry[axis] = F::int(cell[axis].wrapping_add(grid.border_offset[axis]));
        cell[axis] = cell[axis].wrapping_add(grid.step[axis]);
        t_at_border[axis] = grid.t_at_border(cell[axis], axis);
    }
}
