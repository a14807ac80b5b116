//! The exact march: the bilinear patches along the ray intersected in closed form. No steps, no settings, no misses.
//!
//! Here is the plain walk, cell by cell (Amanatides and Woo 1987): the oracle's, that of fields without a pyramid, and what
//! the march of [`crate::descent`] must agree with.

use num_traits::Float;

use crate::descent::{Cost, MAX_TURNS, descend};
use crate::{Bounds, HeightField, Ray};

/// The longest walk, in cells. A ray 0.5° above the surface crosses fewer even in a relief 100 texels deep; one that would
/// go farther still has its hit where it is then: thousands of texels share its pixel.
pub const MAX_CELLS: u32 = 1 << 16;

/// The oracle's longest walk: it is to know better.
const MAX_ORACLE_CELLS: u32 = 1 << 20;

/// f32 for drawing, f64 for the oracle.
pub(crate) trait Real: Float + From<f32> {
    /// The nearest number to an integer.
    fn int(i: i32) -> Self;
    /// The largest integer not above; saturating, 0 for NaN.
    fn floor_int(self) -> i32;
    /// Rounded to f32.
    fn single(self) -> f32;
    /// The first crossing, by the fastest way there is for this field; see [`first_crossing`].
    fn cross(
        field: &impl HeightField,
        line: &Line<Self>,
        start: Self,
        end: Self,
        max_cells: u32,
    ) -> (Crossing<Self>, Cost);
}

impl Real for f32 {
    #[inline]
    fn int(i: i32) -> Self {
        i as Self
    }
    #[inline]
    fn floor_int(self) -> i32 {
        // `floor` is a call on x86-64 without SSE 4.1.
        let truncated = self as i32;
        if (truncated as Self) > self { truncated.wrapping_sub(1) } else { truncated }
    }
    #[inline]
    fn single(self) -> f32 {
        self
    }
    #[inline]
    fn cross(
        field: &impl HeightField,
        line: &Line<f32>,
        start: f32,
        end: f32,
        max_cells: u32,
    ) -> (Crossing<f32>, Cost) {
        match field.pyramid() {
            Some(map) => descend(field, &map, line, start, end, MAX_TURNS),
            None => first_crossing(field, line, start, end, max_cells),
        }
    }
}

impl Real for f64 {
    #[inline]
    fn int(i: i32) -> Self {
        Self::from(i)
    }
    #[inline]
    fn floor_int(self) -> i32 {
        self.floor() as i32
    }
    #[inline]
    fn single(self) -> f32 {
        self as f32
    }
    #[inline]
    fn cross(
        field: &impl HeightField,
        line: &Line<f64>,
        start: f64,
        end: f64,
        max_cells: u32,
    ) -> (Crossing<f64>, Cost) {
        first_crossing(field, line, start, end, max_cells)
    }
}

/// A line through the relief: `uv(s) = uv + slope·s` at height `height + rise·s`.
pub(crate) struct Line<F> {
    pub(crate) uv: [F; 2],
    pub(crate) slope: [F; 2],
    pub(crate) height: F,
    pub(crate) rise: F,
}

/// A march from the lid to the floor.
pub(crate) struct Walk<F> {
    pub(crate) uv: [F; 2],
    /// The uv travelled over the full depth.
    pub(crate) slope: [F; 2],
    pub(crate) bounds: Option<Bounds>,
    /// The ray is known to stay above the surface down to this depth.
    pub(crate) entry: F,
}

/// The smallest depth t in [0, 1] at which the ray is on or below the surface, and what it cost.
pub(crate) fn first_hit<F: Real>(field: &impl HeightField, walk: &Walk<F>, max_cells: u32) -> (Option<F>, Cost) {
    first_hit_by(field, walk, |line, start, end| F::cross(field, line, start, end, max_cells))
}

/// [`first_hit`] with another way to find the first crossing of a line between two depths.
pub(crate) fn first_hit_by<F: Real>(
    field: &impl HeightField,
    walk: &Walk<F>,
    cross: impl FnOnce(&Line<F>, F, F) -> (Crossing<F>, Cost),
) -> (Option<F>, Cost) {
    let [low, high] = field.range().map(<F as From<f32>>::from);
    // Above the highest texel there is nothing to hit, and at the lowest one everything has been hit.
    let (lid, floor) = (F::one() - high, F::one() - low);
    let (enter, exit) = inside(walk);
    // `max` ignores an entry that is not a number.
    let (start, end) = (lid.max(enter).max(walk.entry), floor.min(exit));
    // Also ends where a number is not one.
    if !(start <= end) {
        return (None, Cost::default());
    }
    if is_below(field, walk, enter) {
        return (None, Cost { fetches: 1, gathers: 1, turns: 1 });
    }
    let line = Line { uv: walk.uv, slope: walk.slope, height: F::one(), rise: -F::one() };
    match cross(&line, start, end) {
        (Crossing::At(s) | Crossing::CutOff(s), cost) => (Some(s), cost),
        // Rounding may leave the ray a hair above the floor.
        (Crossing::None, cost) => ((end == floor).then_some(end), cost),
    }
}

/// Whether a ray that comes into its bounds from the side is below the surface there: it sees the relief from behind.
pub(crate) fn enters_below<F: Real>(field: &impl HeightField, walk: &Walk<F>) -> bool {
    let (enter, exit) = inside(walk);
    !(enter <= exit) || is_below(field, walk, enter)
}

/// Whether a ray that comes into its bounds at the depth `enter`, beside the lid, is below the surface there.
fn is_below<F: Real>(field: &impl HeightField, walk: &Walk<F>, enter: F) -> bool {
    let uv = [0, 1].map(|k| (walk.uv[k] + walk.slope[k] * enter).single());
    enter > F::zero() && enter.single() >= 1.0 - field.sample(uv)
}

/// The depths at which the ray comes into the bounds (not above the lid) and leaves them; everything without bounds.
fn inside<F: Real>(walk: &Walk<F>) -> (F, F) {
    let (mut enter, mut exit) = (F::zero(), F::infinity());
    let Some(bounds) = walk.bounds else { return (enter, exit) };
    for k in 0..2 {
        let (min, max) = (<F as From<f32>>::from(bounds.min[k]), <F as From<f32>>::from(bounds.max[k]));
        let (uv, slope) = (walk.uv[k], walk.slope[k]);
        if slope == F::zero() {
            if uv < min || uv > max {
                return (F::infinity(), F::zero());
            }
            continue;
        }
        let (near, far) = if slope > F::zero() { (min, max) } else { (max, min) };
        exit = exit.min((far - uv) / slope);
        // Rounding must not bring a ray that is inside from the start in from the side.
        if uv < min || uv > max {
            enter = enter.max((near - uv) / slope);
        }
    }
    (enter, exit)
}

/// How a walk ended.
pub(crate) enum Crossing<F> {
    /// On or below the surface, for the first time.
    At(F),
    /// At its end, above the surface all the way.
    None,
    /// So far above the surface, when it had crossed as many cells as it may.
    CutOff(F),
}

/// Walks over the cells from `start` to the first s at which the line is on or below the surface, at most to `end`; gives
/// what it cost too.
pub(crate) fn first_crossing<F: Real>(
    field: &impl HeightField,
    line: &Line<F>,
    start: F,
    end: F,
    max_cells: u32,
) -> (Crossing<F>, Cost) {
    let cost = |cells| Cost { fetches: cells, gathers: cells, turns: cells };
    let (zero, one) = (F::zero(), F::one());
    let half: F = 0.5.into();
    let size = field.size().map(|n| F::int(n as i32));
    // Texel-centre coordinates. Cells are counted from the one the line starts in, so that no precision is lost far from
    // the texture's origin.
    let origin = [line.uv[0] * size[0] - half, line.uv[1] * size[1] - half];
    let base = origin.map(Real::floor_int);
    let local = [origin[0] - F::int(base[0]), origin[1] - F::int(base[1])];
    let d = [line.slope[0] * size[0], line.slope[1] * size[1]];

    let position = |s: F| [local[0] + d[0] * s, local[1] + d[1] * s];
    let mut cell = position(start).map(Real::floor_int);
    let step = d.map(|d| if d > zero { 1 } else { -1 });
    let ahead = d.map(|d| i32::from(d > zero));
    let pace = d.map(|d| if d == zero { F::infinity() } else { one / d });
    // The s at which the line leaves column (row) `cell` for the next one. Computed anew for each border: no drift.
    let border = |cell: i32, k: usize| {
        if d[k] == zero { F::infinity() } else { (F::int(cell.wrapping_add(ahead[k])) - local[k]) * pace[k] }
    };
    let mut next = [border(cell[0], 0), border(cell[1], 1)];
    let mut s = start;
    let mut entry = position(s);
    let mut cells = 0;
    loop {
        cells += 1;
        let axis = usize::from(next[1] < next[0]);
        let leave = next[axis].max(s).min(end);
        let corners =
            field.corners(base[0].wrapping_add(cell[0]), base[1].wrapping_add(cell[1])).map(<F as From<f32>>::from);
        let lowest = line.height + line.rise * (if line.rise < zero { leave } else { s });
        // The patch is nowhere above its highest corner: most cells need no more than this.
        if lowest <= corners[0].max(corners[1]).max(corners[2].max(corners[3])) {
            let inside = |k: usize| (entry[k] - F::int(cell[k])).max(zero).min(one);
            if let Some(x) = patch_crossing(corners, [inside(0), inside(1)], d, line, s, leave - s) {
                return (Crossing::At(s + x), cost(cells));
            }
        }
        if leave >= end {
            return (Crossing::None, cost(cells));
        }
        if cells >= max_cells {
            return (Crossing::CutOff(leave), cost(cells));
        }
        s = leave;
        entry = position(s);
        // The line crosses this border exactly; rounding must not put it beside.
        entry[axis] = F::int(cell[axis].wrapping_add(ahead[axis]));
        cell[axis] = cell[axis].wrapping_add(step[axis]);
        next[axis] = border(cell[axis], axis);
    }
}

/// How far beyond `s`, at most `length`, the line meets the bilinear patch over these corners, which it enters at `at` in
/// [0, 1]² and crosses with `d` texels per unit of s.
#[inline]
pub(crate) fn patch_crossing<F: Real>(
    [h00, h10, h01, h11]: [F; 4],
    [a, b]: [F; 2],
    d: [F; 2],
    line: &Line<F>,
    s: F,
    length: F,
) -> Option<F> {
    let (beta, gamma, kappa) = (h10 - h00, h01 - h00, h00 - h10 - h01 + h11);
    // Clearance above the patch along the way: c0 + c1·x + c2·x².
    let c0 = line.height + line.rise * s - (h00 + beta * a + gamma * b + kappa * a * b);
    let c1 = line.rise - (beta * d[0] + gamma * d[1] + kappa * (a * d[1] + b * d[0]));
    let c2 = -kappa * d[0] * d[1];
    first_root(c0, c1, c2, length)
}

/// The smallest x in [0, length] with `c0 + c1·x + c2·x² ≤ 0`.
fn first_root<F: Real>(c0: F, c1: F, c2: F, length: F) -> Option<F> {
    if c0 <= F::zero() {
        return Some(F::zero());
    }
    let (half, four): (F, F) = (0.5.into(), 4.0.into());
    let discriminant = c1 * c1 - four * c2 * c0;
    if discriminant < F::zero() {
        return None;
    }
    // The stable form: no cancellation, and for c2 = 0 one root is infinite and the other right. signum(0) = 1.
    let q = -half * (c1 + c1.signum() * discriminant.sqrt());
    let inside = |x: F| if x > F::zero() && x <= length { x } else { F::infinity() };
    let x = inside(q / c2).min(inside(c0 / q));
    x.is_finite().then_some(x)
}

/// A ray for the [`oracle`], in f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OracleRay {
    /// Where the ray crosses the lid, in texture repeats.
    pub uv: [f64; 2],
    /// The uv travelled from the lid to the floor.
    pub slope: [f64; 2],
}

impl From<&Ray> for OracleRay {
    fn from(ray: &Ray) -> Self {
        let cos = f64::from(ray.cos);
        Self { uv: ray.uv.map(f64::from), slope: ray.uv_delta.map(|x| f64::from(x) / cos) }
    }
}

/// The truth about a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OracleHit {
    /// Where it meets the surface, in texture repeats.
    pub uv: [f64; 2],
    /// How deep: 0 = on the lid, 1 = on the floor.
    pub depth: f64,
}

/// The first intersection with the bilinear surface in f64: what every technique is judged by.
///
/// `None` where the ray leaves `bounds` before it meets the surface, or where it is not finite. A ray that crosses more than
/// a million cells has its hit there.
#[must_use]
pub fn oracle(field: &impl HeightField, ray: &OracleRay, bounds: Option<Bounds>) -> Option<OracleHit> {
    let size = field.size();
    let reach = |k: usize| (ray.uv[k].abs() + ray.slope[k].abs()) * f64::from(size[k]);
    // Also refuses NaN.
    if !(reach(0) < f64::from(1 << 30) && reach(1) < f64::from(1 << 30)) {
        return None;
    }
    let (hit, _) = first_hit(field, &Walk { uv: ray.uv, slope: ray.slope, bounds, entry: 0.0 }, MAX_ORACLE_CELLS);
    let depth = hit?;
    let uv = [ray.uv[0] + ray.slope[0] * depth, ray.uv[1] + ray.slope[1] * depth];
    let inside = |b: Bounds| (0..2).all(|k| uv[k] >= f64::from(b.min[k]) && uv[k] <= f64::from(b.max[k]));
    bounds.is_none_or(inside).then_some(OracleHit { uv, depth })
}
