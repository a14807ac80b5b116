use super::crossing::SurfaceCrossing;
use crate::cost::MarchCost;
use crate::grid_line::Line;
use crate::real::Real;
use crate::{Bounds, HeightField};

/// A march over the cells from the lid to the floor.
pub(crate) struct CellWalk<F> {
    pub(crate) uv: [F; 2],
    /// The uv travelled over the full depth.
    pub(crate) slope: [F; 2],
    pub(crate) bounds: Option<Bounds>,
    /// A depth down to which the ray is known to stay above the surface.
    pub(crate) entry: F,
}

/// Returns the smallest depth t in [0, 1] at which the ray is on or below the surface, and what it cost to find.
/// `find_crossing` finds the first crossing of a line between two depths.
pub(crate) fn first_hit<F: Real>(
    field: &impl HeightField,
    walk: &CellWalk<F>,
    find_crossing: impl FnOnce(&Line<F>, F, F) -> (SurfaceCrossing<F>, MarchCost),
) -> (Option<F>, MarchCost) {
    let [low, high] = field.range().map(<F as From<f32>>::from);
    // Above the highest texel there is nothing to hit, and at the lowest one everything has been hit.
    let (lid, floor) = (F::one() - high, F::one() - low);
    let (enter, exit) = depths_inside(walk);
    // `max` ignores an entry that is not a number.
    let (start, end) = (lid.max(enter).max(walk.entry), floor.min(exit));
    // Also ends where a number is not one.
    if !(start <= end) {
        return (None, MarchCost::default());
    }
    if is_below(field, walk, enter) {
        return (None, MarchCost { fetches: 1, gathers: 1, iterations: 1 });
    }
    let line = Line { uv: walk.uv, slope: walk.slope, height: F::one(), dheight_ds: -F::one() };
    match find_crossing(&line, start, end) {
        (SurfaceCrossing::At(s) | SurfaceCrossing::CutOff(s), cost) => (Some(s), cost),
        // Rounding may leave the ray a hair above the floor.
        (SurfaceCrossing::None, cost) => ((end == floor).then_some(end), cost),
    }
}

/// Returns true if a ray that comes into its bounds from the side is below the surface there: it sees the relief from behind.
pub(crate) fn enters_below<F: Real>(field: &impl HeightField, walk: &CellWalk<F>) -> bool {
    let (enter, exit) = depths_inside(walk);
    !(enter <= exit) || is_below(field, walk, enter)
}

/// Returns true if a ray that comes into its bounds at the depth `enter`, beside the lid, is below the surface there.
fn is_below<F: Real>(field: &impl HeightField, walk: &CellWalk<F>, enter: F) -> bool {
    let uv = [0, 1].map(|k| (walk.uv[k] + walk.slope[k] * enter).single());
    enter > F::zero() && enter.single() >= 1.0 - field.sample(uv)
}

/// Returns the depths at which the ray comes into the bounds (not above the lid) and leaves them; everything without bounds.
fn depths_inside<F: Real>(walk: &CellWalk<F>) -> (F, F) {
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
