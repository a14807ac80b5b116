//! The exact march through the max pyramid: the same cells with the same borders as the walk of [`crate::exact`], but for
//! those in blocks that the ray passes above.

use relievo_map::{Grid, Wrap};

use crate::exact::{Crossing, Line, MAX_CELLS, Real, first_crossing, patch_crossing};
use crate::pyramid::{BITS, Node, SLACK};
use crate::{HeightField, MaxPyramid};

/// More turns than this, and the plain walk takes over.
pub(crate) const MAX_TURNS: u32 = 1 << 14;

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
    /// Turns of the loop.
    pub(crate) turns: u32,
}

/// Where a ray is along one axis: in the endless row of cells, and in the map.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    /// The cell, counted from the one the ray's line starts in.
    cell: i32,
    /// The same cell in the map: 0..n; one less is the cell before the first texel (clamped, mirrored). Clamped, all beyond.
    index: i32,
    /// −1 where the map stands mirrored.
    facing: i32,
    /// Which way the ray goes: ±1.
    step: i32,
    n: i32,
    wrap: Wrap,
}

impl Place {
    pub(crate) fn new(base: i32, cell: i32, step: i32, n: u32, wrap: Wrap) -> Self {
        let (i, n) = (base.wrapping_add(cell), n as i32);
        let (index, facing) = match wrap {
            Wrap::Repeat => (i.rem_euclid(n), 1),
            Wrap::Clamp => (i, 1),
            Wrap::Mirror => {
                let k = i.wrapping_add(1).rem_euclid(2 * n);
                if k <= n { (k - 1, 1) } else { (2 * n - 1 - k, -1) }
            }
        };
        Self { cell, index, facing, step, n, wrap }
    }

    /// Counted in the endless row.
    #[inline]
    pub(crate) fn cell(&self) -> i32 {
        self.cell
    }

    /// The cell whose maximum stands for this one.
    #[inline]
    pub(crate) fn looked_up(&self) -> u32 {
        self.index.max(0).min(self.n - 1) as u32
    }

    /// How many cells the ray enters until it is beyond its block of 2^shift cells; `None` if it never is.
    #[inline]
    pub(crate) fn cells_to_leave(&self, shift: u32) -> Option<i32> {
        let block = (self.looked_up() >> shift) as i32;
        if self.step * self.facing > 0 {
            let beyond = ((block + 1) << shift).min(self.n);
            if self.wrap != Wrap::Repeat && shift == 0 && self.index < 0 {
                return Some(-self.index);
            }
            if self.wrap == Wrap::Clamp && beyond == self.n {
                return None;
            }
            return Some(beyond - self.index);
        }
        let first = block << shift;
        if self.wrap == Wrap::Repeat || first > 0 {
            return Some(self.index - first + 1);
        }
        match (self.wrap, shift) {
            (Wrap::Clamp, 0) if self.index >= 0 => Some(self.index + 1),
            (Wrap::Clamp, _) => None,
            (_, 0) => Some(1),
            // The first block has the cell before it.
            _ => Some(self.index + 2),
        }
    }

    /// Moves on by this many cells, at most to the first one beyond the block.
    #[inline]
    pub(crate) fn advance(&mut self, cells: i32) {
        self.cell = self.cell.wrapping_add(self.step * cells);
        self.index += self.step * self.facing * cells;
        match self.wrap {
            Wrap::Repeat if self.index == self.n => self.index = 0,
            Wrap::Repeat if self.index < 0 => self.index = self.n - 1,
            Wrap::Mirror if self.index == self.n => (self.index, self.facing) = (self.n - 2, -self.facing),
            Wrap::Mirror if self.index == -2 => (self.index, self.facing) = (0, -self.facing),
            _ => {}
        }
    }

    /// The texels on both sides of the cell, in the order in which the endless row has them.
    #[inline]
    fn texels(&self) -> [usize; 2] {
        let last = self.n - 1;
        let first = self.looked_up() as i32;
        let second =
            if self.index >= last { if self.wrap == Wrap::Repeat { 0 } else { last } } else { (self.index + 1).max(0) };
        if self.facing > 0 { [first as usize, second as usize] } else { [second as usize, first as usize] }
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
    #[inline]
    pub(crate) fn node(&self, level: u32, at: [u32; 2]) -> Node {
        let level = &self.pyramid.levels()[level as usize - 1];
        level.nodes()[(at[1] * level.size()[0] + at[0]) as usize]
    }

    #[inline]
    fn corners(&self, [x, y]: &[Place; 2]) -> [f32; 4] {
        let width = self.cells.width() as usize;
        let ([x0, x1], [y0, y1]) = (x.texels(), y.texels());
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
    let pyramid = map.pyramid;
    let size = pyramid.size();
    let origin = [line.uv[0] * size[0] as f32 - 0.5, line.uv[1] * size[1] as f32 - 0.5];
    let base = origin.map(Real::floor_int);
    let local = [origin[0] - base[0] as f32, origin[1] - base[1] as f32];
    let d = [line.slope[0] * size[0] as f32, line.slope[1] * size[1] as f32];
    let position = |s: f32| [local[0] + d[0] * s, local[1] + d[1] * s];
    let ahead = d.map(|d| i32::from(d > 0.0));
    let pace = d.map(|d| if d == 0.0 { f32::INFINITY } else { 1.0 / d });
    // The s at which the line leaves column (row) `cell` for the next one.
    let border = |cell: i32, k: usize| {
        if d[k] == 0.0 { f32::INFINITY } else { (cell.wrapping_add(ahead[k]) as f32 - local[k]) * pace[k] }
    };
    // The line's height in codes, with the slack off.
    let [low, step] = pyramid.coding();
    let per_step = 1.0 / step;
    let slack = SLACK + 4.0 * f32::EPSILON * per_step;
    let (code, code_rise) = ((line.height - low) * per_step - slack, line.rise * per_step);

    let mut s = start;
    let mut entry = position(s);
    let mut at =
        [0, 1].map(|k| Place::new(base[k], entry[k].floor_int(), if d[k] > 0.0 { 1 } else { -1 }, size[k], map.wrap));
    let top = pyramid.levels().len() as u32;
    // From the lid down there is a way to go; elsewhere the surface is near.
    let from_lid = line.height + line.rise * start >= field.range()[1] - 1e-6;
    let texels = pyramid.clearance() * (d[0] * d[0] + d[1] * d[1]).sqrt();
    let mut level = if from_lid { pyramid.start_level(texels) } else { 1 };
    let place =
        |at: &[Place; 2], level: u32| [at[0].looked_up() >> (BITS * level), at[1].looked_up() >> (BITS * level)];
    let mut here = place(&at, level);
    let mut node = map.node(level, here);
    // The node above, where it was loaded on the way down.
    let mut parent: Option<Node> = None;
    let mut cost = Cost { fetches: 1, turns: 0 };
    loop {
        if cost.turns >= max_turns {
            let (crossing, rest) = first_crossing(field, line, s, end, MAX_CELLS - cost.turns);
            return (crossing, Cost { fetches: cost.fetches + rest.fetches, turns: cost.turns + rest.turns });
        }
        cost.turns += 1;
        let shift = BITS * (level - 1);
        let child = [(at[0].looked_up() >> shift) & 3, (at[1].looked_up() >> shift) & 3];
        let highest = node[(child[1] * 4 + child[0]) as usize];
        let cells = [at[0].cells_to_leave(shift), at[1].cells_to_leave(shift)];
        let next = [0, 1].map(|k: usize| match cells[k] {
            Some(cells) => border(at[k].cell.wrapping_add(at[k].step * (cells - 1)), k),
            None => f32::INFINITY,
        });
        let axis = usize::from(next[1] < next[0]);
        let leave = next[axis].max(s).min(end);
        let lowest = if line.rise < 0.0 { leave } else { s };
        if code + code_rise * lowest <= f32::from(highest) {
            if level > 1 {
                level -= 1;
                here = place(&at, level);
                parent = Some(node);
                node = map.node(level, here);
                cost.fetches += 1;
                continue;
            }
            cost.fetches += 1;
            let corners = map.corners(&at);
            if line.height + line.rise * lowest <= corners[0].max(corners[1]).max(corners[2].max(corners[3])) {
                let inside = |k: usize| (entry[k] - at[k].cell as f32).max(0.0).min(1.0);
                if let Some(x) = patch_crossing(corners, [inside(0), inside(1)], d, line, s, leave - s) {
                    return (Crossing::At(s + x), cost);
                }
            }
        }
        if leave >= end {
            return (Crossing::None, cost);
        }
        // The plain walk crosses borders by s, at the same s columns first. The cell across is the one that lies between
        // borders so crossed, this one or the next.
        let crossing = next[axis];
        s = leave;
        entry = position(s);
        let across = 1 - axis;
        if shift > 0 {
            let place = &mut at[across];
            let far = cells[across].map_or(i32::MAX, |cells| cells - 1);
            let progress = if place.step > 0 {
                entry[across] - place.cell as f32
            } else {
                place.cell.wrapping_add(1) as f32 - entry[across]
            };
            let mut moved = ((progress - POINT_SLACK).max(0.0) as i32).min(far);
            let border = border(place.cell.wrapping_add(place.step * moved), across);
            if moved < far && (border < crossing || (border == crossing && across == 0)) {
                moved += 1;
            }
            place.advance(moved);
        }
        at[axis].advance(cells[axis].unwrap_or(0));
        // The line crosses this border exactly; rounding must not put it beside.
        entry[axis] = at[axis].cell.wrapping_sub(at[axis].step).wrapping_add(ahead[axis]) as f32;

        let before = here;
        here = place(&at, level);
        if here != before {
            let above = [before[0] >> BITS, before[1] >> BITS];
            if let Some(cached) = parent
                && above == [here[0] >> BITS, here[1] >> BITS]
            {
                level += 1;
                here = above;
                node = cached;
                parent = None;
            } else {
                if above != [here[0] >> BITS, here[1] >> BITS] && level < top {
                    level += 1;
                    here = here.map(|n| n >> BITS);
                }
                parent = None;
                node = map.node(level, here);
                cost.fetches += 1;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use relievo_map::HeightMap;

    use super::*;
    use crate::Heights;

    /// Rays on terraces from the lid down; how many of them find another place than the plain walk.
    fn differences(spoil: impl Fn(&mut MaxPyramid), max_turns: u32) -> usize {
        let height = |x: u32, y: u32| {
            let hills = 0.5 + 0.3 * (x as f32 * 0.31).sin() * (y as f32 * 0.17).cos() + 0.2 * (x as f32 * 1.3).sin();
            (hills * 10.0).floor() / 10.0
        };
        let heights = Heights::new(&HeightMap::new(Grid::from_fn(70, 50, height)));
        let field = heights.field(0.0, Wrap::Repeat);
        let mut pyramid = heights.pyramids()[0].clone();
        spoil(&mut pyramid);
        let map = PyramidField { pyramid: &pyramid, ..field.pyramid().unwrap() };
        (0..5000)
            .filter(|&i| {
                let even = |k: f64| (0.5 + f64::from(i) * k).fract() as f32;
                let angle = even(0.819_172_5) * std::f32::consts::TAU;
                let slope = [angle.cos(), angle.sin()].map(|x| x * 4.0 * even(0.671_043_6).powi(3));
                let line = Line { uv: [even(0.754_877_7), even(0.569_840_3)], slope, height: 1.0, rise: -1.0 };
                let s = |crossing| match crossing {
                    Crossing::At(s) => Some(s),
                    _ => None,
                };
                let found = s(descend(&field, &map, &line, 0.0, 1.0, max_turns).0);
                match (found, s(first_crossing(&field, &line, 0.0, 1.0, MAX_CELLS).0)) {
                    (Some(a), Some(b)) => (a - b).abs() > 1e-6,
                    (a, b) => a != b,
                }
            })
            .count()
    }

    #[test]
    fn a_pyramid_rounded_down_is_caught() {
        let lowered = |pyramid: &mut MaxPyramid| pyramid.map_codes(|code| code.saturating_sub(1));
        assert_eq!(differences(|_| (), MAX_TURNS), 0);
        let caught = differences(lowered, MAX_TURNS);
        assert!(caught >= 30, "only {caught} of 5000 rays tell a pyramid that is too low");
    }

    #[test]
    fn at_the_bound_of_the_turns_the_plain_walk_goes_on() {
        for max_turns in [1, 2, 3, 7, 20] {
            assert_eq!(differences(|_| (), max_turns), 0, "{max_turns} turns");
        }
    }
}
