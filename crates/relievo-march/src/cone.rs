//! The march through cones: the cells of the plain walk, but for those that a cone says the ray passes above.

use crate::cone_map::{ConeField, ENDLESS};
use crate::descent::Cost;
use crate::exact::{Crossing, Line, MAX_CELLS, Real, patch_crossing};
use crate::pyramid::SLACK;
use crate::{Cones, HeightField, MAX_REFINE_STEPS, MarchOptions};

/// How much wider than it is the gap of a texel is taken to be, from which a cone's side rises: rounding moves rays by
/// fractions of a texel.
const RIM: f32 = 1.015625;

/// As [`crate::exact::first_crossing`], for a line that sinks by 1 per unit of s, through cones.
///
/// Each turn looks at one cell. If the line is above the cone's top where it leaves the cell, the cone says how much farther it
/// may go; else the cell's patch is intersected in closed form.
///
/// With [`Cones::Conservative`] the cells that are left are looked at with the plain walk's own numbers: borders are
/// computed anew from the line's origin, and the cell after a step is the one between the borders that lie before its end.
/// With [`Cones::Relaxed`] a step may end below the surface, which it has met once then; bisections find where.
pub(crate) fn cone_crossing(
    field: &impl HeightField,
    cones: &ConeField<'_>,
    line: &Line<f32>,
    start: f32,
    end: f32,
    options: &MarchOptions,
) -> (Crossing<f32>, Cost) {
    let relaxed = cones.map.cones() == Cones::Relaxed;
    let most = if relaxed { options.cone_steps() } else { MAX_CELLS };
    let view = View::new(field.size(), line);
    let View { base, d, step, .. } = view;
    let speed = (d[0] * d[0] + d[1] * d[1]).sqrt();
    // Codes are heights up to rounding, and rays too.
    let slack = SLACK * cones.map.quantization_step() + 4.0 * f32::EPSILON;

    let mut s = start;
    let mut entry = view.position(s);
    let mut cell = entry.map(Real::floor_int);
    let mut next = [view.border(cell[0], 0), view.border(cell[1], 1)];
    // Where the line came into its column and row; those that it started in have no such place.
    let mut entered = [f32::NEG_INFINITY; 2];
    // Where the step began that ended here, and the cell it began in.
    let mut stepped_from: Option<(f32, [i32; 2])> = None;
    let mut cost = Cost::default();
    loop {
        if cost.turns >= most {
            return (Crossing::CutOff(s), cost);
        }
        cost.turns += 1;
        cost.fetches += 1;
        let at = [0, 1].map(|k| base[k].wrapping_add(cell[k]));
        let cone = cones.at(at);
        let axis = usize::from(next[1] < next[0]);
        let leave = next[axis].max(s).min(end);
        let lowest = line.height - leave;
        let above = lowest - cones.map.top(cone) - slack;
        if above <= 0.0 {
            cost.fetches += 1;
            let corners = field.corners(at[0], at[1]);
            if lowest <= corners[0].max(corners[1]).max(corners[2].max(corners[3])) {
                let inside = [0, 1].map(|k| (entry[k] - cell[k] as f32).max(0.0).min(1.0));
                if let Some(x) = patch_crossing(corners, inside, d, line, s, leave - s) {
                    if let Some(from) = stepped_from.filter(|_| x <= 0.0) {
                        let (s, samples) = bisect(field, &view, line, from, (s, cell), options.refine_steps);
                        cost.fetches += samples;
                        cost.turns += samples;
                        return (Crossing::At(s), cost);
                    }
                    return (Crossing::At(s + x), cost);
                }
            }
        }
        if leave >= end {
            return (Crossing::None, cost);
        }
        // From the border on, as far as the cone allows.
        let slope = cones.map.slope(cone);
        let mut target = leave + (above - RIM * slope) / (1.0 + speed * slope);
        if relaxed {
            for k in 0..2 {
                let cells = cones.reach(at[k], step[k], k);
                if cells < ENDLESS {
                    target = target.min(view.border(cell[k].wrapping_add(step[k] * (cells - 1)), k));
                }
            }
        }
        target = target.min(end);

        entered[axis] = next[axis];
        cell[axis] = cell[axis].wrapping_add(step[axis]);
        next[axis] = view.border(cell[axis], axis);
        stepped_from = None;
        if target > leave {
            if !relaxed && target >= end {
                return (Crossing::None, cost);
            }
            if relaxed {
                stepped_from = Some((leave, cell));
            }
            let position = view.position(target);
            for k in 0..2 {
                let cells = view.crossed(cell[k], position[k], target, k);
                if cells > 0 {
                    cell[k] = cell[k].wrapping_add(step[k].wrapping_mul(cells));
                    entered[k] = view.border(cell[k].wrapping_sub(step[k]), k);
                    next[k] = view.border(cell[k], k);
                }
            }
        }
        if stepped_from.is_some() {
            s = target;
            entry = view.position(s);
        } else {
            // The plain walk crosses columns first where it crosses both, and comes in by the border it crossed last.
            let last = usize::from(entered[1] >= entered[0]);
            s = entered[last].max(start);
            entry = view.position(s);
            entry[last] = cell[last].wrapping_sub(step[last]).wrapping_add(view.ahead[last]) as f32;
        }
    }
}

/// A line over the cells, which are counted from the one it starts in, so that no precision is lost far from the texture's
/// origin.
#[derive(Clone, Copy)]
struct View {
    base: [i32; 2],
    local: [f32; 2],
    d: [f32; 2],
    step: [i32; 2],
    ahead: [i32; 2],
    pace: [f32; 2],
}

impl View {
    fn new(size: [u32; 2], line: &Line<f32>) -> Self {
        let size = size.map(|n| n as f32);
        let origin = [line.uv[0] * size[0] - 0.5, line.uv[1] * size[1] - 0.5];
        let base = origin.map(Real::floor_int);
        let d = [line.slope[0] * size[0], line.slope[1] * size[1]];
        Self {
            base,
            local: [origin[0] - base[0] as f32, origin[1] - base[1] as f32],
            d,
            step: d.map(|d| if d > 0.0 { 1 } else { -1 }),
            ahead: d.map(|d| i32::from(d > 0.0)),
            pace: d.map(|d| if d == 0.0 { f32::INFINITY } else { 1.0 / d }),
        }
    }

    #[inline]
    fn position(&self, s: f32) -> [f32; 2] {
        [self.local[0] + self.d[0] * s, self.local[1] + self.d[1] * s]
    }

    /// The s at which the line leaves column (row) `cell` for the next one.
    #[inline]
    fn border(&self, cell: i32, k: usize) -> f32 {
        if self.d[k] == 0.0 {
            return f32::INFINITY;
        }
        (cell.wrapping_add(self.ahead[k]) as f32 - self.local[k]) * self.pace[k]
    }

    /// How many borders the line crosses from column (row) `cell` up to s, where it is at `position`.
    #[inline]
    fn crossed(&self, cell: i32, position: f32, s: f32, k: usize) -> i32 {
        let progress = if self.step[k] > 0 { position - cell as f32 } else { cell.wrapping_add(1) as f32 - position };
        let cells = progress.max(0.0) as i32;
        let border = |cells: i32| self.border(cell.wrapping_add(self.step[k].wrapping_mul(cells)), k);
        // Rounding may put the position beside its cell; what counts is the borders.
        if border(cells) <= s {
            cells.saturating_add(1)
        } else if cells > 0 && border(cells - 1) > s {
            cells - 1
        } else {
            cells
        }
    }
}

/// Where the line meets the surface between a place above it and one below, both with their cells; and how many cells were
/// looked at. Halves the way until both are in one cell, whose patch tells the place; at most `steps` times.
fn bisect(
    field: &impl HeightField,
    view: &View,
    line: &Line<f32>,
    (mut above, mut cell_above): (f32, [i32; 2]),
    (mut below, mut cell_below): (f32, [i32; 2]),
    steps: u32,
) -> (f32, u32) {
    let corners_of =
        |cell: [i32; 2]| field.corners(view.base[0].wrapping_add(cell[0]), view.base[1].wrapping_add(cell[1]));
    let inside = |s: f32, cell: [i32; 2]| {
        let position = view.position(s);
        [0, 1].map(|k| (position[k] - cell[k] as f32).max(0.0).min(1.0))
    };
    let mut samples = 0;
    while cell_above != cell_below {
        if samples >= steps.min(MAX_REFINE_STEPS) {
            return (0.5 * (above + below), samples);
        }
        samples += 1;
        let middle = 0.5 * (above + below);
        let cell = view.position(middle).map(Real::floor_int);
        let [h00, h10, h01, h11] = corners_of(cell);
        let [a, b] = inside(middle, cell);
        let surface = h00 + (h10 - h00) * a + (h01 - h00) * b + (h00 - h10 - h01 + h11) * a * b;
        if line.height - middle <= surface {
            (below, cell_below) = (middle, cell);
        } else {
            (above, cell_above) = (middle, cell);
        }
    }
    // Loaded already: the place below is in the cell that was looked at last.
    let crossing =
        patch_crossing(corners_of(cell_below), inside(above, cell_below), view.d, line, above, below - above);
    (above + crossing.unwrap_or(below - above), samples)
}

#[cfg(test)]
mod tests {
    use relievo_map::{Grid, HeightMap, Wrap};

    use super::*;
    use crate::exact::first_crossing;
    use crate::{ConeMap, ReliefMap};

    /// Rays on bumps from the lid down; how many of them find another place than the plain walk.
    fn differences(spoil: impl Fn(&mut ConeMap)) -> usize {
        let height = |x: u32, y: u32| {
            let hills = 0.5 + 0.3 * (x as f32 * 0.31).sin() * (y as f32 * 0.17).cos() + 0.2 * (x as f32 * 1.3).sin();
            (hills * 10.0).floor() / 10.0
        };
        let heights = ReliefMap::new(&HeightMap::new(Grid::from_fn(70, 50, height))).with_cones(Cones::Conservative);
        let field = heights.field(0.0, Wrap::Repeat);
        let mut cones = heights.cones(Cones::Conservative).unwrap()[0].clone();
        spoil(&mut cones);
        let cones = ConeField::new(&cones, Wrap::Repeat);
        (0..200_000)
            .filter(|&i| {
                let even = |k: f64| (0.5 + f64::from(i) * k).fract() as f32;
                let angle = even(0.819_172_5) * std::f32::consts::TAU;
                let slope = [angle.cos(), angle.sin()].map(|x| x * 4.0 * even(0.671_043_6).powi(3));
                let line = Line { uv: [even(0.754_877_7), even(0.569_840_3)], slope, height: 1.0, rise: -1.0 };
                let s = |crossing| match crossing {
                    Crossing::At(s) => Some(s),
                    _ => None,
                };
                let found = s(cone_crossing(&field, &cones, &line, 0.0, 1.0, &MarchOptions::default()).0);
                found != s(first_crossing(&field, &line, 0.0, 1.0, MAX_CELLS).0)
            })
            .count()
    }

    #[test]
    fn cones_that_are_too_wide_are_caught() {
        assert_eq!(differences(|_| ()), 0);
        let lower = differences(|cones| cones.map_texels(|[top, slope]| [top.saturating_sub(1), slope]));
        assert!(lower >= 30, "only {lower} of 200000 rays tell cones that stand one code too low");
        let wider = differences(|cones| cones.map_texels(|[top, slope]| [top, slope.saturating_sub(8)]));
        assert!(wider >= 100, "only {wider} of 200000 rays tell cones whose sides are flatter by a third");
    }
}
