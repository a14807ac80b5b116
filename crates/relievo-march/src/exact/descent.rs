//! The exact march through the max pyramid: the same cells with the same borders as the plain walk, but for those in blocks
//! that the ray passes above.

use relievo_map::Wrap;

use super::crossing::SurfaceCrossing;
use super::path::{LinePath, NearCell, Path};
use super::visited_cell::VisitedCell;
use crate::HeightField;
use crate::cost::{MAX_CELLS, MarchCost};
use crate::grid_line::Line;
use crate::pyramid::{BITS, MaxPyramid, Node, PyramidField, child_index};
use crate::real::Real;
use crate::wrapped_axis::{AxisCell, CLAMP, MIRROR, NEVER, REPEAT, WrappedAxis};

/// The longest march, as long as the plain walk's: an iteration goes a cell further or more, or a level down after one that
/// did.
pub(crate) const MAX_ITERATIONS: u32 = MAX_CELLS;

/// The distance by which rounding may put a point beside its cell, in texels.
const POINT_SLACK: f32 = 1.0 / 64.0;

/// Finds the first crossing as the plain walk does, through the pyramid.
pub(crate) fn descend(
    field: &impl HeightField,
    map: &PyramidField<'_>,
    path: &impl Path,
    start: f32,
    end: f32,
    max_iterations: u32,
) -> (SurfaceCrossing<f32>, MarchCost) {
    visit_path(field, map, path, [start, end], max_iterations, |cell| {
        path.patch(cell.corners, cell.cell, cell.inside(), cell.s, cell.t_exit).map(|x| cell.s + x)
    })
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
    mut visit: impl FnMut(&VisitedCell<f32>) -> Option<f32>,
) -> (SurfaceCrossing<f32>, MarchCost) {
    let path = LinePath::new(map.pyramid, line);
    visit_path(field, map, &path, [start, end], max_iterations, |cell| visit(&path.visited(cell)))
}

/// Calls `visit` with every cell of a way but those in blocks that it passes above, until it returns an s.
#[inline(always)]
fn visit_path<P: Path>(
    field: &impl HeightField,
    map: &PyramidField<'_>,
    path: &P,
    range: [f32; 2],
    max_iterations: u32,
    visit: impl FnMut(&NearCell) -> Option<f32>,
) -> (SurfaceCrossing<f32>, MarchCost) {
    let lid = field.range()[1];
    match map.wrap {
        Wrap::Repeat => visit_by::<REPEAT, _>(map, path, range, max_iterations, lid, visit),
        Wrap::Clamp => visit_by::<CLAMP, _>(map, path, range, max_iterations, lid, visit),
        Wrap::Mirror => visit_by::<MIRROR, _>(map, path, range, max_iterations, lid, visit),
    }
}

/// [`visit_path`] in one wrap mode.
fn visit_by<const WRAP: u8, P: Path>(
    map: &PyramidField<'_>,
    path: &P,
    [start, end]: [f32; 2],
    max_iterations: u32,
    lid: f32,
    mut visit: impl FnMut(&NearCell) -> Option<f32>,
) -> (SurfaceCrossing<f32>, MarchCost) {
    let wrapped = WrappedPath::<WRAP, P>::new(map.pyramid.size(), path);
    let (base, [columns, rows]) = (path.base(), wrapped.axes);
    let top = map.pyramid.top();

    let (mut s, mut entry) = (start, path.position(start));
    let mut at = [columns.at(base[0], entry[0].floor_int()), rows.at(base[1], entry[1].floor_int())];
    let mut cell = wrapped.map_cell(at);
    let mut level = start_level(map.pyramid, path, start, lid);
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
        if path.lowest(s, t_exit) <= highest {
            cost.fetches += 1;
            if level > 1 {
                level -= 1;
                parent = Some(node);
                node = map.node_of(level, cell);
                continue;
            }
            cost.gathers += 1;
            let corners = map.corners(columns.texels(at[0]), rows.texels(at[1]));
            let near = NearCell { corners, entry, cell: [at[0].cell, at[1].cell], s, t_exit };
            if let Some(found) = visit(&near) {
                return (SurfaceCrossing::At(found), cost);
            }
        }
        if t_exit >= end {
            return (SurfaceCrossing::None, cost);
        }
        s = t_exit;
        entry = path.position(s);
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
fn start_level(pyramid: &MaxPyramid, path: &impl Path, start: f32, lid: f32) -> u32 {
    if path.height(start) >= lid - 1e-6 { pyramid.start_level(pyramid.clearance() * path.speed()) } else { 1 }
}

/// A way over a map that is continued beyond its borders.
struct WrappedPath<'a, const WRAP: u8, P> {
    path: &'a P,
    /// Columns and rows.
    axes: [WrappedAxis<WRAP>; 2],
}

impl<'a, const WRAP: u8, P: Path> WrappedPath<'a, WRAP, P> {
    #[inline]
    fn new(size: [u32; 2], path: &'a P) -> Self {
        Self { path, axes: size.map(|n| WrappedAxis { n: n as i32 }) }
    }

    /// Returns the edge by which the way leaves a column (row).
    #[inline(always)]
    fn exit_edge(&self, cell: i32, k: usize) -> i32 {
        cell.wrapping_add(i32::from(self.path.step()[k] > 0))
    }

    /// Returns the s at which the line leaves the `cells`-th column (row) from this one on.
    #[inline]
    fn t_at_border(&self, at: AxisCell, cells: i32, k: usize) -> f32 {
        let edge = self.exit_edge(at.cell.wrapping_add(self.path.step()[k] * (cells - 1)), k);
        if cells == NEVER { f32::INFINITY } else { self.path.crossing(edge, k) }
    }

    /// Returns the numbers of columns and rows that the line enters until it is beyond its block.
    #[inline]
    fn cells_to_exit(&self, at: [AxisCell; 2], bit_shift: u32) -> [i32; 2] {
        let ([columns, rows], step) = (self.axes, self.path.step());
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
        let step = self.path.step();
        if along_v {
            let crossed = self.cells_crossed(at[0], cells[0], 0, entry[0], t_crossed, bit_shift);
            at[0] = columns.advanced(at[0], step[0], crossed);
            at[1] = rows.advanced(at[1], step[1], cells[1]);
            entry[1] = self.exit_edge(at[1].cell.wrapping_sub(step[1]), 1) as f32;
        } else {
            let crossed = self.cells_crossed(at[1], cells[1], 1, entry[1], t_crossed, bit_shift);
            at[1] = rows.advanced(at[1], step[1], crossed);
            at[0] = columns.advanced(at[0], step[0], cells[0]);
            entry[0] = self.exit_edge(at[0].cell.wrapping_sub(step[0]), 0) as f32;
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
            if self.path.step()[k] > 0 { position - at.cell as f32 } else { at.cell.wrapping_add(1) as f32 - position };
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
            let found = s(descend(
                field,
                &PyramidField { pyramid: &pyramid, ..*map },
                &LinePath::new(&pyramid, line),
                0.0,
                1.0,
                MAX_ITERATIONS,
            )
            .0);
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
                match descend(field, map, &LinePath::new(map.pyramid, line), 0.0, 1.0, max_iterations) {
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
