//! The exact march through the max pyramid: the same cells with the same borders as the walk of [`crate::exact`], but for
//! those in blocks that the ray passes above.

use relievo_map::{Grid, Wrap};

use crate::exact::{Crossing, Line, MAX_CELLS, Real, patch_crossing};
use crate::pyramid::{BITS, Node, SLACK};
use crate::{HeightField, MaxPyramid};

/// The longest march, as long as the plain walk's: a turn goes a cell further or more, or a level down after one that did.
pub(crate) const MAX_TURNS: u32 = MAX_CELLS;

/// How far rounding may put a point beside its cell, in texels.
const POINT_SLACK: f32 = 1.0 / 64.0;

/// A map with its pyramid, as rays see it.
#[derive(Clone, Copy, Debug)]
pub struct PyramidField<'a> {
    pub(crate) cells: &'a Grid<f32>,
    pub(crate) pyramid: &'a MaxPyramid,
    pub(crate) wrap: Wrap,
}

/// What a march cost.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Cost {
    /// Nodes and cells that were loaded.
    pub(crate) fetches: u32,
    /// The cells among them.
    pub(crate) gathers: u32,
    /// Turns of the loop.
    pub(crate) turns: u32,
}

/// Where a ray is along one axis: in the endless row of cells, and in the map.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    /// The cell, counted from the one the ray's line starts in.
    pub(crate) cell: i32,
    /// The same cell in the map: 0..n; one less is the cell before the first texel (clamped, mirrored). Clamped, all beyond.
    index: i32,
    /// −1 where the map stands mirrored.
    facing: i32,
}

/// More cells than any ray crosses: a block that goes on for ever.
pub(crate) const NEVER: i32 = 1 << 30;

/// The cells of a map along one axis, with what lies beyond; the wrap mode a constant, as loops have one each.
#[derive(Clone, Copy)]
pub(crate) struct Row<const WRAP: u8> {
    /// Cells in the map.
    pub(crate) n: i32,
}

pub(crate) const REPEAT: u8 = 0;
pub(crate) const CLAMP: u8 = 1;
pub(crate) const MIRROR: u8 = 2;

impl<const WRAP: u8> Row<WRAP> {
    /// Of a cell counted from the cell `base`.
    #[inline(always)]
    pub(crate) fn place(self, base: i32, cell: i32) -> Place {
        let (i, n) = (base.wrapping_add(cell), self.n);
        let (index, facing) = match WRAP {
            REPEAT if (i as u32) < n as u32 => (i, 1),
            REPEAT => (i.rem_euclid(n), 1),
            CLAMP => (i, 1),
            _ => {
                let k = i.wrapping_add(1).rem_euclid(2 * n);
                if k <= n { (k - 1, 1) } else { (2 * n - 1 - k, -1) }
            }
        };
        Place { cell, index, facing }
    }

    /// The cell whose maximum stands for this one.
    #[inline(always)]
    pub(crate) fn looked_up(self, place: Place) -> u32 {
        if WRAP == REPEAT { place.index as u32 } else { place.index.max(0).min(self.n - 1) as u32 }
    }

    /// How many cells a ray that goes by `step` (±1) enters until it is beyond its block of 2^shift cells, or [`NEVER`].
    #[inline(always)]
    pub(crate) fn cells_to_leave(self, place: Place, step: i32, shift: u32) -> i32 {
        let (index, rest) = (place.index, (1 << shift) - 1);
        let looked_up = self.looked_up(place) as i32;
        let (beyond, first) = (((looked_up | rest) + 1).min(self.n), looked_up & !rest);
        let [up, down] = match WRAP {
            REPEAT => [beyond - index, index - first + 1],
            // The first block has all cells before it, and the last all behind.
            CLAMP => [
                if shift == 0 && index < 0 {
                    -index
                } else if beyond == self.n {
                    NEVER
                } else {
                    beyond - index
                },
                if first > 0 || (shift == 0 && index >= 0) { index - first + 1 } else { NEVER },
            ],
            _ if shift == 0 => [1, 1],
            // The first block has the cell before it.
            _ => [beyond - index, if first > 0 { index - first + 1 } else { index + 2 }],
        };
        if step * place.facing > 0 { up } else { down }
    }

    /// The place this many cells on, at most the first one beyond the block.
    #[inline(always)]
    pub(crate) fn advanced(self, place: Place, step: i32, cells: i32) -> Place {
        let n = self.n;
        let cell = place.cell.wrapping_add(step * cells);
        let index = place.index + step * place.facing * cells;
        let (index, facing) = match WRAP {
            REPEAT => (
                if index == n {
                    0
                } else if index < 0 {
                    n - 1
                } else {
                    index
                },
                1,
            ),
            CLAMP => (index, 1),
            _ if index == n => (n - 2, -place.facing),
            _ if index == -2 => (0, -place.facing),
            _ => (index, place.facing),
        };
        Place { cell, index, facing }
    }

    /// The texels on both sides of the cell, in the order in which the endless row has them.
    #[inline(always)]
    fn texels(self, place: Place) -> [usize; 2] {
        let last = self.n - 1;
        let first = self.looked_up(place) as usize;
        let second = match place.index + 1 {
            next if next > last => {
                if WRAP == REPEAT {
                    0
                } else {
                    last
                }
            }
            next => next.max(0),
        } as usize;
        if place.facing > 0 { [first, second] } else { [second, first] }
    }
}

impl<'a> PyramidField<'a> {
    /// A map with a pyramid that was built of it and kept up to date: what [`HeightField::pyramid`] gives.
    ///
    /// # Panics
    /// If they differ in size.
    #[must_use]
    pub fn new(cells: &'a Grid<f32>, pyramid: &'a MaxPyramid, wrap: Wrap) -> Self {
        assert_eq!(pyramid.size(), [cells.width(), cells.height()], "the pyramid is that of the map");
        Self { cells, pyramid, wrap }
    }
}

impl PyramidField<'_> {
    #[inline(always)]
    pub(crate) fn node(&self, level: u32, at: [u32; 2]) -> &Node {
        let level = self.pyramid.level(level);
        &level.nodes()[(at[1] * level.size()[0] + at[0]) as usize]
    }

    #[inline(always)]
    fn corners(&self, [x0, x1]: [usize; 2], [y0, y1]: [usize; 2]) -> [f32; 4] {
        let width = self.cells.width() as usize;
        let texels = self.cells.texels();
        let (top, bottom) = (&texels[y0 * width..(y0 + 1) * width], &texels[y1 * width..(y1 + 1) * width]);
        [top[x0], top[x1], bottom[x0], bottom[x1]]
    }
}

/// As [`first_crossing`] of the plain walk, through the pyramid.
pub(crate) fn descend(
    field: &impl HeightField,
    map: &PyramidField<'_>,
    line: &Line<f32>,
    start: f32,
    end: f32,
    max_turns: u32,
) -> (Crossing<f32>, Cost) {
    match map.wrap {
        Wrap::Repeat => descend_by::<REPEAT>(map, line, start, end, max_turns, field.range()[1]),
        Wrap::Clamp => descend_by::<CLAMP>(map, line, start, end, max_turns, field.range()[1]),
        Wrap::Mirror => descend_by::<MIRROR>(map, line, start, end, max_turns, field.range()[1]),
    }
}

/// [`descend`] in one wrap mode.
fn descend_by<const WRAP: u8>(
    map: &PyramidField<'_>,
    line: &Line<f32>,
    start: f32,
    end: f32,
    max_turns: u32,
    lid: f32,
) -> (Crossing<f32>, Cost) {
    let pyramid = map.pyramid;
    let [columns, rows] = pyramid.size().map(|n| Row::<WRAP> { n: n as i32 });
    let size = pyramid.size().map(|n| n as f32);
    let origin = [line.uv[0] * size[0] - 0.5, line.uv[1] * size[1] - 0.5];
    let base = origin.map(Real::floor_int);
    let local = [origin[0] - base[0] as f32, origin[1] - base[1] as f32];
    let d = [line.slope[0] * size[0], line.slope[1] * size[1]];
    let position = |s: f32| [local[0] + d[0] * s, local[1] + d[1] * s];
    let step = d.map(|d| if d > 0.0 { 1 } else { -1 });
    let ahead = d.map(|d| i32::from(d > 0.0));
    let flat = d.map(|d| d == 0.0);
    let pace = d.map(|d| if d == 0.0 { f32::INFINITY } else { 1.0 / d });
    // The s at which the line leaves the `cells`-th column (row) from here on.
    let border = |place: Place, cells: i32, k: usize| {
        let edge = place.cell.wrapping_add(step[k] * (cells - 1)).wrapping_add(ahead[k]);
        if flat[k] | (cells == NEVER) { f32::INFINITY } else { (edge as f32 - local[k]) * pace[k] }
    };
    // The line's height in codes, with the slack off.
    let [low, code_step] = pyramid.coding();
    let per_step = 1.0 / code_step;
    let slack = SLACK + 4.0 * f32::EPSILON * per_step;
    let (code, code_rise) = ((line.height - low) * per_step - slack, line.rise * per_step);
    let sinks = line.rise < 0.0;

    let mut s = start;
    let mut entry = position(s);
    let (mut x, mut y) = (columns.place(base[0], entry[0].floor_int()), rows.place(base[1], entry[1].floor_int()));
    let top = pyramid.top();
    // From the lid down there is a way to go; elsewhere the surface is near.
    let mut level = 1;
    if line.height + line.rise * start >= lid - 1e-6 {
        level = pyramid.start_level(pyramid.clearance() * (d[0] * d[0] + d[1] * d[1]).sqrt());
    }
    let here = |x: Place, y: Place| [columns.looked_up(x), rows.looked_up(y)];
    let mut cell = here(x, y);
    let mut node = map.node(level, cell.map(|i| i >> (BITS * level)));
    // The node above, where it was loaded on the way down.
    let mut parent: Option<&Node> = None;
    let mut cost = Cost { fetches: 1, ..Cost::default() };
    loop {
        if cost.turns >= max_turns {
            return (Crossing::CutOff(s), cost);
        }
        cost.turns += 1;
        let shift = BITS * (level - 1);
        let highest = node[(((cell[1] >> shift) & 3) * 4 + ((cell[0] >> shift) & 3)) as usize];
        let cells = [columns.cells_to_leave(x, step[0], shift), rows.cells_to_leave(y, step[1], shift)];
        let next = [border(x, cells[0], 0), border(y, cells[1], 1)];
        let along_v = next[1] < next[0];
        let crossing = if along_v { next[1] } else { next[0] };
        let leave = crossing.max(s).min(end);
        let lowest = if sinks { leave } else { s };
        if code + code_rise * lowest <= f32::from(highest) {
            cost.fetches += 1;
            if level > 1 {
                level -= 1;
                parent = Some(node);
                node = map.node(level, cell.map(|i| i >> (BITS * level)));
                continue;
            }
            cost.gathers += 1;
            let corners = map.corners(columns.texels(x), rows.texels(y));
            if line.height + line.rise * lowest <= corners[0].max(corners[1]).max(corners[2].max(corners[3])) {
                let inside = [entry[0] - x.cell as f32, entry[1] - y.cell as f32].map(|a| a.max(0.0).min(1.0));
                if let Some(beyond) = patch_crossing(corners, inside, d, line, s, leave - s) {
                    return (Crossing::At(s + beyond), cost);
                }
            }
        }
        if leave >= end {
            return (Crossing::None, cost);
        }
        s = leave;
        entry = position(s);
        // The line crosses one border exactly; rounding must not put it beside. Along the other axis the plain walk
        // crosses borders by s, at the same s columns first: the cell is the one between borders so crossed.
        let across = |place: Place, cells: i32, k: usize| {
            if shift == 0 {
                return 0;
            }
            let progress =
                if step[k] > 0 { entry[k] - place.cell as f32 } else { place.cell.wrapping_add(1) as f32 - entry[k] };
            let whole = ((progress - POINT_SLACK).max(0.0) as i32).min(cells - 1);
            let border = border(place, whole + 1, k);
            let crossed = if k == 0 { border <= crossing } else { border < crossing };
            whole + i32::from(crossed & (whole < cells - 1))
        };
        if along_v {
            x = columns.advanced(x, step[0], across(x, cells[0], 0));
            y = rows.advanced(y, step[1], cells[1]);
            entry[1] = y.cell.wrapping_sub(step[1]).wrapping_add(ahead[1]) as f32;
        } else {
            y = rows.advanced(y, step[1], across(y, cells[1], 1));
            x = columns.advanced(x, step[0], cells[0]);
            entry[0] = x.cell.wrapping_sub(step[0]).wrapping_add(ahead[0]) as f32;
        }

        let before = cell;
        cell = here(x, y);
        // What differs between the cells before and now, from the lowest bit on.
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
        node = map.node(level, cell.map(|i| i >> (BITS * level)));
        cost.fetches += 1;
    }
}

#[cfg(test)]
mod tests {
    use relievo_map::HeightMap;

    use super::*;
    use crate::ReliefMap;
    use crate::exact::first_crossing;

    /// Some lines from the lid down into terraces.
    fn for_lines(count: u32, mut each: impl FnMut(&crate::HeightFieldView<'_>, &PyramidField<'_>, &Line<f32>)) {
        let height = |x: u32, y: u32| {
            let hills = 0.5 + 0.3 * (x as f32 * 0.31).sin() * (y as f32 * 0.17).cos() + 0.2 * (x as f32 * 1.3).sin();
            (hills * 10.0).floor() / 10.0
        };
        let heights = ReliefMap::new(&HeightMap::new(Grid::from_fn(70, 50, height)));
        let field = heights.field(0.0, Wrap::Repeat);
        let map = field.pyramid().unwrap();
        for i in 0..count {
            let even = |k: f64| (0.5 + f64::from(i) * k).fract() as f32;
            let angle = even(0.819_172_5) * std::f32::consts::TAU;
            let slope = [angle.cos(), angle.sin()].map(|x| x * 4.0 * even(0.671_043_6).powi(3));
            each(&field, &map, &Line { uv: [even(0.754_877_7), even(0.569_840_3)], slope, height: 1.0, rise: -1.0 });
        }
    }

    /// How many of 5000 lines find another place than by the plain walk.
    fn differences(spoil: impl Fn(&mut MaxPyramid)) -> usize {
        let mut differ = 0;
        for_lines(5000, |field, map, line| {
            let mut pyramid = map.pyramid.clone();
            spoil(&mut pyramid);
            let s = |crossing| match crossing {
                Crossing::At(s) => Some(s),
                _ => None,
            };
            let found = s(descend(field, &PyramidField { pyramid: &pyramid, ..*map }, line, 0.0, 1.0, MAX_TURNS).0);
            differ += usize::from(match (found, s(first_crossing(field, line, 0.0, 1.0, MAX_CELLS).0)) {
                (Some(a), Some(b)) => (a - b).abs() > 1e-6,
                (a, b) => a != b,
            });
        });
        differ
    }

    #[test]
    fn a_pyramid_rounded_down_is_caught() {
        let lowered = |pyramid: &mut MaxPyramid| pyramid.map_codes(|code| code.saturating_sub(1));
        assert_eq!(differences(|_| ()), 0);
        let caught = differences(lowered);
        assert!(caught >= 30, "only {caught} of 5000 rays tell a pyramid that is too low");
    }

    #[test]
    fn a_march_that_is_cut_off_is_above_the_surface_still() {
        for max_turns in [1, 2, 3, 7, 20] {
            let (mut cut_off, rays) = (0, 500);
            for_lines(rays, |field, map, line| {
                let Crossing::At(hit) = first_crossing(field, line, 0.0, 1.0, MAX_CELLS).0 else { return };
                match descend(field, map, line, 0.0, 1.0, max_turns) {
                    (Crossing::CutOff(s), cost) => {
                        cut_off += 1;
                        assert!(s <= hit && cost.turns == max_turns, "{s} of {hit}");
                    }
                    (Crossing::At(s), _) => assert_eq!(s, hit),
                    (Crossing::None, _) => panic!("{hit} was missed"),
                }
            });
            assert!(cut_off > 0, "{max_turns} turns are enough for all {rays}");
        }
    }
}
