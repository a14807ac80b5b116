//! The march through cones: the cells of the plain walk, but for those that the ray passes above by a cone.

use super::cone_field::{ConeField, ENDLESS};
use super::cones::Cones;
use crate::cost::{MAX_CELLS, MarchCost};
use crate::exact::SurfaceCrossing;
use crate::grid_line::{GridLine, Line, inside_cell};
use crate::patch::patch_crossing;
use crate::pyramid::SLACK;
use crate::real::Real;
use crate::{HeightField, MAX_REFINE_STEPS, MarchOptions};

/// The width taken for the gap of one texel, from which a cone's side rises: rounding moves rays by fractions of a texel.
const RIM: f32 = 1.015625;

/// Finds the first crossing as the plain walk does, for a line that sinks by 1 per unit of s, through cones.
///
/// Each iteration looks at one cell. If the line is above the cone's top where it leaves the cell, the cone bounds the step
/// that it takes from there; else the cell's patch is intersected in closed form.
///
/// With [`Cones::Conservative`] the remaining cells are looked at with the plain walk's own numbers: borders are computed
/// anew from the line's origin, and the cell after a step is the one between the borders that lie before its end.
/// With [`Cones::Relaxed`] a step may end below the surface, which it has met once then; bisections find the crossing.
pub(crate) fn cone_crossing(
    field: &impl HeightField,
    cones: &ConeField<'_>,
    line: &Line<f32>,
    start: f32,
    end: f32,
    options: &MarchOptions,
) -> (SurfaceCrossing<f32>, MarchCost) {
    let relaxed = cones.map.cones() == Cones::Relaxed;
    let max_iterations = if relaxed { options.cone_steps() } else { MAX_CELLS };
    let grid = GridLine::new(field.size(), field.texel_offset(), line);
    // Quantized heights are heights up to rounding, and rays too.
    let slack = SLACK * cones.map.quantization_step() + 4.0 * f32::EPSILON;
    let steps = ConeSteps { cones, grid, speed: (grid.d[0] * grid.d[0] + grid.d[1] * grid.d[1]).sqrt(), relaxed };

    let mut at = ConeCursor::new(&grid, start);
    // The s at which the step began that ended here, and the cell it began in.
    let mut stepped_from: Option<(f32, [i32; 2])> = None;
    let mut cost = MarchCost::default();
    loop {
        if cost.iterations >= max_iterations {
            return (SurfaceCrossing::CutOff(at.s), cost);
        }
        cost.iterations += 1;
        cost.fetches += 1;
        let map_cell = grid.map_cell(at.cell);
        let cone = cones.at(map_cell);
        let axis = usize::from(at.t_at_border[1] < at.t_at_border[0]);
        let t_exit = at.t_at_border[axis].max(at.s).min(end);
        let lowest = line.height - t_exit;
        let above = lowest - cones.map.top(cone) - slack;
        if above <= 0.0 {
            cost.fetches += 1;
            let corners = field.corners(map_cell[0], map_cell[1]);
            if lowest <= corners[0].max(corners[1]).max(corners[2].max(corners[3])) {
                let inside = [0, 1].map(|k| inside_cell(at.entry[k], at.cell[k]));
                if let Some(x) = patch_crossing(corners, inside, grid.d, line, at.s, t_exit - at.s) {
                    if let Some(from) = stepped_from.filter(|_| x <= 0.0) {
                        let (s, samples) = bisect(field, &grid, line, from, (at.s, at.cell), options.refine_steps);
                        cost.fetches += samples;
                        cost.iterations += samples;
                        return (SurfaceCrossing::At(s), cost);
                    }
                    return (SurfaceCrossing::At(at.s + x), cost);
                }
            }
        }
        if t_exit >= end {
            return (SurfaceCrossing::None, cost);
        }
        let target = steps.target(map_cell, at.cell, cone, t_exit, above).min(end);
        at.cross_border(&grid, axis);
        stepped_from = None;
        if target > t_exit {
            if !relaxed && target >= end {
                return (SurfaceCrossing::None, cost);
            }
            if relaxed {
                stepped_from = Some((t_exit, at.cell));
            }
            at.cross_borders(&grid, target);
        }
        if stepped_from.is_some() {
            at.enter_inside(&grid, target);
        } else {
            at.enter_by_border(&grid, start);
        }
    }
}

/// The steps of a line that cones allow.
struct ConeSteps<'a> {
    cones: &'a ConeField<'a>,
    grid: GridLine<f32>,
    /// Texels per unit of s.
    speed: f32,
    relaxed: bool,
}

impl ConeSteps<'_> {
    /// Returns the s up to which the cone of a cell lets the line go on, which leaves the cell at `t_exit`, `above` the cone's
    /// top.
    #[inline(always)]
    fn target(&self, map_cell: [i32; 2], cell: [i32; 2], cone: [u8; 2], t_exit: f32, above: f32) -> f32 {
        let slope = self.cones.map.slope(cone);
        let mut target = t_exit + (above - RIM * slope) / (1.0 + self.speed * slope);
        if self.relaxed {
            let step = self.grid.step;
            for k in 0..2 {
                let cells = self.cones.reach(map_cell[k], step[k], k);
                if cells < ENDLESS {
                    target = target.min(self.grid.t_at_border(cell[k].wrapping_add(step[k] * (cells - 1)), k));
                }
            }
        }
        target
    }
}

/// The position of a march through cones.
struct ConeCursor {
    s: f32,
    /// The position at s, exactly on the border that the line has crossed, if it has.
    entry: [f32; 2],
    cell: [i32; 2],
    /// The s at which the line leaves its column and row.
    t_at_border: [f32; 2],
    /// The s at which the line came into its column and row; −∞ for those that it started in.
    t_entered: [f32; 2],
}

impl ConeCursor {
    #[inline(always)]
    fn new(grid: &GridLine<f32>, s: f32) -> Self {
        let entry = grid.position(s);
        let cell = entry.map(Real::floor_int);
        let t_at_border = [grid.t_at_border(cell[0], 0), grid.t_at_border(cell[1], 1)];
        Self { s, entry, cell, t_at_border, t_entered: [f32::NEG_INFINITY; 2] }
    }

    /// Goes on by one column (row).
    #[inline(always)]
    fn cross_border(&mut self, grid: &GridLine<f32>, axis: usize) {
        self.t_entered[axis] = self.t_at_border[axis];
        self.cell[axis] = self.cell[axis].wrapping_add(grid.step[axis]);
        self.t_at_border[axis] = grid.t_at_border(self.cell[axis], axis);
    }

    /// Goes on over all borders that the line crosses up to s.
    #[inline(always)]
    fn cross_borders(&mut self, grid: &GridLine<f32>, s: f32) {
        let position = grid.position(s);
        for k in 0..2 {
            let cells = borders_crossed(grid, self.cell[k], position[k], s, k);
            if cells > 0 {
                self.cell[k] = self.cell[k].wrapping_add(grid.step[k].wrapping_mul(cells));
                self.t_entered[k] = grid.t_at_border(self.cell[k].wrapping_sub(grid.step[k]), k);
                self.t_at_border[k] = grid.t_at_border(self.cell[k], k);
            }
        }
    }

    /// Moves s to a point inside the cell.
    #[inline(always)]
    fn enter_inside(&mut self, grid: &GridLine<f32>, s: f32) {
        self.s = s;
        self.entry = grid.position(s);
    }

    /// Moves s to the border that the line crossed last. The plain walk crosses columns first where it crosses both.
    #[inline(always)]
    fn enter_by_border(&mut self, grid: &GridLine<f32>, start: f32) {
        let last = usize::from(self.t_entered[1] >= self.t_entered[0]);
        self.enter_inside(grid, self.t_entered[last].max(start));
        self.entry[last] = grid.entry_edge(self.cell[last], last);
    }
}

/// Returns the number of borders that the line crosses from column (row) `cell` up to s, where it is at `position`.
#[inline]
fn borders_crossed(grid: &GridLine<f32>, cell: i32, position: f32, s: f32, k: usize) -> i32 {
    let progress = if grid.step[k] > 0 { position - cell as f32 } else { cell.wrapping_add(1) as f32 - position };
    let cells = progress.max(0.0) as i32;
    let t_at_border = |cells: i32| grid.t_at_border(cell.wrapping_add(grid.step[k].wrapping_mul(cells)), k);
    // Rounding may put the position beside its cell; the borders decide.
    if t_at_border(cells) <= s {
        cells.saturating_add(1)
    } else if cells > 0 && t_at_border(cells - 1) > s {
        cells - 1
    } else {
        cells
    }
}

/// Returns the s at which the line meets the surface between a point above it and one below, both with their cells, and the
/// number of cells looked at. Halves the interval until both ends are in one cell, whose patch gives the crossing; at most
/// `steps` times.
fn bisect(
    field: &impl HeightField,
    grid: &GridLine<f32>,
    line: &Line<f32>,
    (mut above, mut cell_above): (f32, [i32; 2]),
    (mut below, mut cell_below): (f32, [i32; 2]),
    steps: u32,
) -> (f32, u32) {
    let corners_of = |cell: [i32; 2]| {
        let [i, j] = grid.map_cell(cell);
        field.corners(i, j)
    };
    let inside = |s: f32, cell: [i32; 2]| {
        let position = grid.position(s);
        [0, 1].map(|k| inside_cell(position[k], cell[k]))
    };
    let mut samples = 0;
    while cell_above != cell_below {
        if samples >= steps.min(MAX_REFINE_STEPS) {
            return (0.5 * (above + below), samples);
        }
        samples += 1;
        let middle = 0.5 * (above + below);
        let cell = grid.position(middle).map(Real::floor_int);
        let [h00, h10, h01, h11] = corners_of(cell);
        let [a, b] = inside(middle, cell);
        let surface = h00 + (h10 - h00) * a + (h01 - h00) * b + (h00 - h10 - h01 + h11) * a * b;
        if line.height - middle <= surface {
            (below, cell_below) = (middle, cell);
        } else {
            (above, cell_above) = (middle, cell);
        }
    }
    // Loaded already: the point below is in the cell that was looked at last.
    let crossing =
        patch_crossing(corners_of(cell_below), inside(above, cell_below), grid.d, line, above, below - above);
    (above + crossing.unwrap_or(below - above), samples)
}

#[cfg(test)]
mod tests {
    use relievo_map::{Grid, HeightMap, Wrap};

    use super::*;
    use crate::exact::walk_cells;
    use crate::{ConeMap, ReliefMap};

    /// Counts the rays on bumps from the lid down whose crossing is not the plain walk's.
    fn differences(distort: impl Fn(&mut ConeMap)) -> usize {
        let height = |x: u32, y: u32| {
            let hills = 0.5 + 0.3 * (x as f32 * 0.31).sin() * (y as f32 * 0.17).cos() + 0.2 * (x as f32 * 1.3).sin();
            (hills * 10.0).floor() / 10.0
        };
        let heights = ReliefMap::new(&HeightMap::new(Grid::from_fn(70, 50, height))).with_cones(Cones::Conservative);
        let field = heights.field(0.0, Wrap::Repeat);
        let mut cones = heights.cones(Cones::Conservative).unwrap()[0].clone();
        distort(&mut cones);
        let cones = ConeField::new(&cones, Wrap::Repeat);
        (0..200_000)
            .filter(|&i| {
                let fraction = |k: f64| (0.5 + f64::from(i) * k).fract() as f32;
                let angle = fraction(0.819_172_5) * std::f32::consts::TAU;
                let slope = [angle.cos(), angle.sin()].map(|x| x * 4.0 * fraction(0.671_043_6).powi(3));
                let line =
                    Line { uv: [fraction(0.754_877_7), fraction(0.569_840_3)], slope, height: 1.0, dheight_ds: -1.0 };
                let s = |crossing| match crossing {
                    SurfaceCrossing::At(s) => Some(s),
                    _ => None,
                };
                let found = s(cone_crossing(&field, &cones, &line, 0.0, 1.0, &MarchOptions::default()).0);
                found != s(walk_cells(&field, &line, 0.0, 1.0, MAX_CELLS).0)
            })
            .count()
    }

    #[test]
    fn cones_that_are_too_wide_are_caught() {
        assert_eq!(differences(|_| ()), 0);
        let lower = differences(|cones| cones.map_texels(|[top, slope]| [top.saturating_sub(1), slope]));
        assert!(lower >= 30, "only {lower} of 200000 rays tell cones that stand one step too low");
        let wider = differences(|cones| cones.map_texels(|[top, slope]| [top, slope.saturating_sub(8)]));
        assert!(wider >= 100, "only {wider} of 200000 rays tell cones whose sides are flatter by a third");
    }
}
