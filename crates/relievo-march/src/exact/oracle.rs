use super::cell_walk::{CellWalk, first_hit};
use super::plain::walk_cells;
use crate::{Bounds, HeightField, Ray};

/// The oracle's longest walk, in cells: it must outlast every march.
const MAX_ORACLE_CELLS: u32 = 1 << 20;

/// A ray for the [`oracle`], in f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OracleRay {
    /// The point where the ray crosses the lid, in texture repeats.
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

/// The true hit of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OracleHit {
    /// The point where the ray meets the surface, in texture repeats.
    pub uv: [f64; 2],
    /// Its depth: 0 = on the lid, 1 = on the floor.
    pub depth: f64,
}

/// Finds the first intersection with the bilinear surface in f64: the reference that every technique is judged by.
///
/// `None` where the ray leaves `bounds` before it meets the surface, or where it is not finite. A ray that crosses more than
/// a million cells has its hit there.
#[must_use]
pub fn oracle(field: &impl HeightField, ray: &OracleRay, bounds: Option<Bounds>) -> Option<OracleHit> {
    oracle_from(field, ray, bounds, 0.0)
}

/// Finds the first intersection from the depth `entry` on: for rays that begin below the lid. See [`oracle`].
#[must_use]
pub fn oracle_from(field: &impl HeightField, ray: &OracleRay, bounds: Option<Bounds>, entry: f64) -> Option<OracleHit> {
    let size = field.size();
    let reach = |k: usize| (ray.uv[k].abs() + ray.slope[k].abs()) * f64::from(size[k]);
    // Also refuses NaN.
    if !(reach(0) < f64::from(1 << 30) && reach(1) < f64::from(1 << 30)) {
        return None;
    }
    let walk = CellWalk { uv: ray.uv, slope: ray.slope, bounds, entry };
    let (hit, _) = first_hit(field, &walk, |line, start, end| walk_cells(field, line, start, end, MAX_ORACLE_CELLS));
    let depth = hit?;
    let uv = [ray.uv[0] + ray.slope[0] * depth, ray.uv[1] + ray.slope[1] * depth];
    let inside = |b: Bounds| (0..2).all(|k| uv[k] >= f64::from(b.min[k]) && uv[k] <= f64::from(b.max[k]));
    bounds.is_none_or(inside).then_some(OracleHit { uv, depth })
}
