//! The exact march: the bilinear patches along the ray intersected in closed form. No steps, no settings, no misses.

mod cell_walk;
mod crossing;
mod descent;
mod oracle;
mod path;
mod plain;
mod visited_cell;

pub(crate) use cell_walk::{CellWalk, enters_below, first_hit};
pub(crate) use crossing::SurfaceCrossing;
use descent::visit_near_cells;
pub(crate) use descent::{MAX_ITERATIONS, descend};
pub use oracle::{OracleHit, OracleRay, oracle, oracle_from};
pub(crate) use path::{LinePath, Path, Quantization};
use plain::visit_cells;
pub(crate) use plain::walk_cells;
pub(crate) use visited_cell::VisitedCell;

use crate::HeightField;
use crate::cost::{MAX_CELLS, MarchCost};
use crate::grid_line::Line;

/// Finds the first crossing by the fastest march there is for this field: through its pyramid, else the plain walk.
#[inline]
pub(crate) fn first_crossing(
    field: &impl HeightField,
    line: &Line<f32>,
    start: f32,
    end: f32,
    max_cells: u32,
) -> (SurfaceCrossing<f32>, MarchCost) {
    match field.pyramid() {
        Some(map) => descend(field, &map, &LinePath::new(map.pyramid, line), start, end, MAX_ITERATIONS),
        None => walk_cells(field, line, start, end, max_cells),
    }
}

/// Calls `visit` with every cell along the line that it does not pass above, in order, until it returns an s: through the
/// field's pyramid where it has one.
#[inline]
pub(crate) fn visit_cells_near(
    field: &impl HeightField,
    line: &Line<f32>,
    start: f32,
    end: f32,
    visit: impl FnMut(&VisitedCell<f32>) -> Option<f32>,
) -> (SurfaceCrossing<f32>, MarchCost) {
    match field.pyramid() {
        Some(map) => visit_near_cells(field, &map, line, start, end, MAX_ITERATIONS, visit),
        None => visit_cells(field, line, start, end, MAX_CELLS, visit),
    }
}
