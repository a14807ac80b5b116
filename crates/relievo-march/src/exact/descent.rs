//! The exact march through the max pyramid: the same cells with the same borders as the plain walk, but for those in blocks
//! that the ray passes above.

use relievo_map::Wrap;

use super::crossing::SurfaceCrossing;
use super::visited_cell::VisitedCell;
use crate::HeightField;
use crate::cost::{MAX_CELLS, MarchCost};
use crate::grid_line::{GridLine, Line};
use crate::pyramid::{BITS, MaxPyramid, Node, PyramidField, SLACK, child_index};
use crate::real::Real;
use crate::wrapped_axis::{AxisCell, CLAMP, MIRROR, NEVER, REPEAT, WrappedAxis};

/// The longest march, as long as the plain walk's: an iteration goes a cell further or more, or a level down after one that
/// did.
pub(crate) const MAX_ITERATIONS: u32 = MAX_CELLS;

/// The distance by which rounding may put a point beside its cell, in texels.
const POINT_SLACK: f32 = 1.0 / 64.0;

/// Finds the first crossing as the plain walk does, through the pyramid.
pub(super) fn descend(
    field: &impl HeightField,
    map: &PyramidField<'_>,
    line: &Line<f32>,
    start: f32,
    end: f32,
    max_iterations: u32,
) -> (SurfaceCrossing<f32>, MarchCost) {
    let first = |cell: &VisitedCell<f32>| cell.crossing(line).map(|x| cell.s + x);
    visit_near_cells(field, map, line, start, end, max_iterations, first)
}

/// Calls `visit` with every cell from `start` to `end` but those in blocks that the line passes above, until it returns an s.
#[inline(always)]
pub(crate) fn visit_near_cells(
    field: &impl HeightField,
    map: &PyramidField<'_>,
    line: &Line<f32>,
    start: f32,
    end: f32,
    max_iterations: u32,
    visit: impl FnMut(&VisitedCell<f32>) -> Option<f32>,
) -> (SurfaceCrossing<f32>, MarchCost) {
    let (lid, range) = (field.range()[1], [start, end]);
    match map.wrap {
        Wrap::Repeat => visit_by::<REPEAT>(map, line, range, max_iterations, lid, visit),
        Wrap::Clamp => visit_by::<CLAMP>(map, line, range, max_iterations, lid, visit),
        Wrap::Mirror => visit_by::<MIRROR>(map, line, range, max_iterations, lid, visit),
    }
}

/// [`visit_near_cells`] in one wrap mode.
fn visit_by<const WRAP: u8>(
    map: &PyramidField<'_>,
    line: &Line<f32>,
    [start, end]: [f32; 2],
    max_iterations: u32,
    lid: f32,
    mut visit: impl FnMut(&VisitedCell<f32>) -> Option<f32>,
) -> (SurfaceCrossing<f32>, MarchCost) {
    let wrapped = WrappedLine::<WRAP>::new(map.pyramid.size(), line);
    let WrappedLine { grid, axes: [columns, rows] } = wrapped;
    let quantized = QuantizedLine::new(map.pyramid, line);
    let (sinks, top) = (line.dheight_ds < 0.0, map.pyramid.top());

    let (mut s, mut entry) = (start, grid.position(start));
    let mut at = [columns.at(grid.base[0], entry[0].floor_int()), rows.at(grid.base[1], entry[1].floor_int())];
    let mut cell = wrapped.map_cell(at);
    let mut level = start_level(map.pyramid, line, grid.d, start, lid);
    let mut node = map.node_of(level, cell);
    // The node above, where it was loaded on the way down.
    let mut parent: Option<&Node> = None;
    let mut cost = MarchCost { fetches: 1, ..MarchCost::default() };
    loop {
        if cost.iterations >= max_iterations {
            return (SurfaceCrossing::CutOff(s), cost);
        }
        cost.iterations += 1;
        let bit_shift = BITS * (level - 1);
        let highest = f32::from(node[child_index(cell.map(|i| i >> bit_shift))]);
        let cells = wrapped.cells_to_exit(at, bit_shift);
        let t_at_border = [wrapped.t_at_border(at[0], cells[0], 0), wrapped.t_at_border(at[1], cells[1], 1)];
        let along_v = t_at_border[1] < t_at_border[0];
        let t_crossed = if along_v { t_at_border[1] } else { t_at_border[0] };
        let t_exit = t_crossed.max(s).min(end);
        let t_lowest = if sinks { t_exit } else { s };
        if quantized.height + quantized.dheight_ds * t_lowest <= highest {
            cost.fetches += 1;
            if level > 1 {
                level -= 1;
                parent = Some(node);
                node = map.node_of(level, cell);
                continue;
            }
            cost.gathers += 1;
            let corners = map.corners(columns.texels(at[0]), rows.texels(at[1]));
            let lowest = line.height + line.dheight_ds * t_lowest;
            let cell = [at[0].cell, at[1].cell];
            if let Some(found) = visit(&VisitedCell { corners, lowest, entry, cell, d: grid.d, s, t_exit }) {
                return (SurfaceCrossing::At(found), cost);
            }
        }
        if t_exit >= end {
            return (SurfaceCrossing::None, cost);
        }
        s = t_exit;
        entry = grid.position(s);
        wrapped.advance(&mut at, &mut entry, cells, along_v, t_crossed, bit_shift);
        let before = cell;
        cell = wrapped.map_cell(at);
        // The bits in which the cells before and now differ.
        let moved = (before[0] ^ cell[0]) | (before[1] ^ cell[1]);
        if moved >> (BITS * level) == 0 {
            continue;
        }
        let same_parent = moved >> (BITS * (level + 1)) == 0;
        if let Some(cached) = parent.take()
            && same_parent
        {
            level += 1;
            node = cached;
            continue;
        }
        if !same_parent && level < top {
            level += 1;
        }
        node = map.node_of(level, cell);
        cost.fetches += 1;
    }
}

/// Returns the level to begin with: from the lid down there is some way to go; elsewhere the surface is near.
#[inline]
fn start_level(pyramid: &MaxPyramid, line: &Line<f32>, d: [f32; 2], start: f32, lid: f32) -> u32 {
    if line.height + line.dheight_ds * start >= lid - 1e-6 {
        pyramid.start_level(pyramid.clearance() * (d[0] * d[0] + d[1] * d[1]).sqrt())
    } else {
        1
    }
}

/// A line's height in the pyramid's quantization steps, with the slack off.
struct QuantizedLine {
    height: f32,
    dheight_ds: f32,
}

impl QuantizedLine {
    #[inline]
    fn new(pyramid: &MaxPyramid, line: &Line<f32>) -> Self {
        let [low, step] = pyramid.quantization();
        let per_step = 1.0 / step;
        let slack = SLACK + 4.0 * f32::EPSILON * per_step;
        Self { height: (line.height - low) * per_step - slack, dheight_ds: line.dheight_ds * per_step }
    }
}

/// A line over a map that is continued beyond its borders.
#[derive(Clone, Copy)]
struct WrappedLine<const WRAP: u8> {
    grid: GridLine<f32>,
    /// Columns and rows.
    axes: [WrappedAxis<WRAP>; 2],
}

impl<const WRAP: u8> WrappedLine<WRAP> {
    #[inline]
    fn new(size: [u32; 2], line: &Line<f32>) -> Self {
        Self { grid: GridLine::new(size, 0.5, line), axes: size.map(|n| WrappedAxis { n: n as i32 }) }
    }

    /// Returns the s at which the line leaves the `cells`-th column (row) from this one on.
    #[inline]
    fn t_at_border(&self, at: AxisCell, cells: i32, k: usize) -> f32 {
        let grid = &self.grid;
        let edge = at.cell.wrapping_add(grid.step[k] * (cells - 1)).wrapping_add(grid.border_offset[k]);
        if (grid.d[k] == 0.0) | (cells == NEVER) { f32::INFINITY } else { grid.t_at_edge(edge, k) }
    }

    /// Returns the numbers of columns and rows that the line enters until it is beyond its block.
    #[inline]
    fn cells_to_exit(&self, at: [AxisCell; 2], bit_shift: u32) -> [i32; 2] {
        let ([columns, rows], step) = (self.axes, self.grid.step);
        [columns.cells_to_exit(at[0], step[0], bit_shift), rows.cells_to_exit(at[1], step[1], bit_shift)]
    }

    /// Returns the cell of the map whose maximum stands for these columns and rows.
    #[inline]
    fn map_cell(&self, at: [AxisCell; 2]) -> [u32; 2] {
        [self.axes[0].map_index(at[0]), self.axes[1].map_index(at[1])]
    }

    /// Goes on to the cell beyond the block, whose border along one axis is crossed at `t_crossed`; `entry` is the position
    /// there. The line crosses that border exactly; rounding must not put it beside.
    #[inline]
    fn advance(
        &self,
        at: &mut [AxisCell; 2],
        entry: &mut [f32; 2],
        cells: [i32; 2],
        along_v: bool,
        t_crossed: f32,
        bit_shift: u32,
    ) {
        let [columns, rows] = self.axes;
        let step = self.grid.step;
        if along_v {
            let crossed = self.cells_crossed(at[0], cells[0], 0, entry[0], t_crossed, bit_shift);
            at[0] = columns.advanced(at[0], step[0], crossed);
            at[1] = rows.advanced(at[1], step[1], cells[1]);
            entry[1] = self.grid.entry_edge(at[1].cell, 1);
        } else {
            let crossed = self.cells_crossed(at[1], cells[1], 1, entry[1], t_crossed, bit_shift);
            at[1] = rows.advanced(at[1], step[1], crossed);
            at[0] = columns.advanced(at[0], step[0], cells[0]);
            entry[0] = self.grid.entry_edge(at[0].cell, 0);
        }
    }

    /// Returns the number of borders that the line crosses along axis `k` until it leaves its block along the other one.
    ///
    /// The plain walk crosses borders by s, at the same s columns first: the cell is the one between borders so crossed.
    #[inline]
    fn cells_crossed(&self, at: AxisCell, cells: i32, k: usize, position: f32, t_crossed: f32, bit_shift: u32) -> i32 {
        if bit_shift == 0 {
            return 0;
        }
        let progress =
            if self.grid.step[k] > 0 { position - at.cell as f32 } else { at.cell.wrapping_add(1) as f32 - position };
        let whole = ((progress - POINT_SLACK).max(0.0) as i32).min(cells - 1);
        let t_at_border = self.t_at_border(at, whole + 1, k);
        let crossed = if k == 0 { t_at_border <= t_crossed } else { t_at_border < t_crossed };
        whole + i32::from(crossed & (whole < cells - 1))
    }
}

#[cfg(test)]
mod tests {
    use relievo_map::{Grid, HeightMap};

    use super::*;
    use crate::exact::plain::walk_cells;
    use crate::{HeightFieldView, ReliefMap};

    /// Calls `each` with lines from the lid down into terraces.
    fn for_lines(count: u32, mut each: impl FnMut(&HeightFieldView<'_>, &PyramidField<'_>, &Line<f32>)) {
        let height = |x: u32, y: u32| {
            let hills = 0.5 + 0.3 * (x as f32 * 0.31).sin() * (y as f32 * 0.17).cos() + 0.2 * (x as f32 * 1.3).sin();
            (hills * 10.0).floor() / 10.0
        };
        let heights = ReliefMap::new(&HeightMap::new(Grid::from_fn(70, 50, height)));
        let field = heights.field(0.0, Wrap::Repeat);
        let map = field.pyramid().unwrap();
        for i in 0..count {
            let fraction = |k: f64| (0.5 + f64::from(i) * k).fract() as f32;
            let angle = fraction(0.819_172_5) * std::f32::consts::TAU;
            let slope = [angle.cos(), angle.sin()].map(|x| x * 4.0 * fraction(0.671_043_6).powi(3));
            each(
                &field,
                &map,
                &Line { uv: [fraction(0.754_877_7), fraction(0.569_840_3)], slope, height: 1.0, dheight_ds: -1.0 },
            );
        }
    }

    /// Counts the lines of 5000 whose crossing is not the plain walk's.
    fn differences(distort: impl Fn(&mut MaxPyramid)) -> usize {
        let mut differ = 0;
        for_lines(5000, |field, map, line| {
            let mut pyramid = map.pyramid.clone();
            distort(&mut pyramid);
            let s = |crossing| match crossing {
                SurfaceCrossing::At(s) => Some(s),
                _ => None,
            };
            let found =
                s(descend(field, &PyramidField { pyramid: &pyramid, ..*map }, line, 0.0, 1.0, MAX_ITERATIONS).0);
            differ += usize::from(match (found, s(walk_cells(field, line, 0.0, 1.0, MAX_CELLS).0)) {
                (Some(a), Some(b)) => (a - b).abs() > 1e-6,
                (a, b) => a != b,
            });
        });
        differ
    }

    #[test]
    fn a_pyramid_rounded_down_is_caught() {
        let lowered = |pyramid: &mut MaxPyramid| pyramid.map_quantized(|height| height.saturating_sub(1));
        assert_eq!(differences(|_| ()), 0);
        let caught = differences(lowered);
        assert!(caught >= 30, "only {caught} of 5000 rays tell a pyramid that is too low");
    }

    #[test]
    fn a_march_that_is_cut_off_is_above_the_surface_still() {
        for max_iterations in [1, 2, 3, 7, 20] {
            let (mut cut_off, rays) = (0, 500);
            for_lines(rays, |field, map, line| {
                let SurfaceCrossing::At(hit) = walk_cells(field, line, 0.0, 1.0, MAX_CELLS).0 else { return };
                match descend(field, map, line, 0.0, 1.0, max_iterations) {
                    (SurfaceCrossing::CutOff(s), cost) => {
                        cut_off += 1;
                        assert!(s <= hit && cost.iterations == max_iterations, "{s} of {hit}");
                    }
                    (SurfaceCrossing::At(s), _) => assert_eq!(s, hit),
                    (SurfaceCrossing::None, _) => panic!("{hit} was missed"),
                }
            });
            assert!(cut_off > 0, "{max_iterations} iterations are enough for all {rays}");
        }
    }
}
