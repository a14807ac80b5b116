//! The exact march: the bilinear patches along the ray intersected in closed form. No steps, no settings, no misses.

mod cell_walk;
mod crossing;
mod descent;
mod oracle;
mod path;
mod plain;

pub(crate) use cell_walk::{CellWalk, enters_below, first_hit};
pub(crate) use crossing::SurfaceCrossing;
pub(crate) use descent::{MAX_ITERATIONS, descend};
pub use oracle::{OracleHit, OracleRay, oracle, oracle_from};
pub(crate) use path::{LinePath, Path, Quantization};
pub(crate) use plain::walk_cells;

use crate::HeightField;
use crate::cost::MarchCost;
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
