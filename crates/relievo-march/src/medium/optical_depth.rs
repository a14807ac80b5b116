use super::cell_layer::CellLayer;
use crate::HeightField;
use crate::exact::{SurfaceCrossing, visit_cells_near};
use crate::grid_line::Line;

/// The optical depth at which an integral ends: one part in nine million of the light is left.
pub const MAX_OPTICAL_DEPTH: f32 = 16.0;

/// A medium that fills the relief from its surface down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Medium {
    /// Extinction per unit of the ray's distance, where the medium is full; 0 or more.
    pub density: f32,
    /// Depth below the surface, as a fraction of the full depth, over which the density grows from 0; 0 = a hard surface.
    pub softness: f32,
}

/// A ray through a relief in any direction, by distance: at the distance s it is at `uv + uv_delta·s` and at the height
/// `height + height_delta·s` (1 = the lid, 0 = the floor).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MediumRay {
    /// Texture coordinates at distance 0, in texture repeats.
    pub uv: [f32; 2],
    /// The uv travelled per unit of distance.
    pub uv_delta: [f32; 2],
    /// Height at distance 0.
    pub height: f32,
    /// Height gained per unit of distance.
    pub height_delta: f32,
}

impl MediumRay {
    /// Returns true if every number is finite and the ray reaches no texel that f32 and i32 cannot address.
    fn is_usable(&self, size: [u32; 2], [start, end]: [f32; 2]) -> bool {
        let reach = |k: usize| (self.uv[k].abs() + self.uv_delta[k].abs() * end.abs()) * size[k] as f32;
        let far = (1 << 30) as f32;
        // Also false for NaN.
        self.height.is_finite() && self.height_delta.is_finite() && start < end && reach(0) < far && reach(1) < far
    }

    fn line(&self) -> Line<f32> {
        Line { uv: self.uv, slope: self.uv_delta, height: self.height, dheight_ds: self.height_delta }
    }
}

/// The optical depth of a part of a ray, and the cost of finding it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OpticalDepth {
    /// Integral of the extinction; [`MAX_OPTICAL_DEPTH`] at most.
    pub value: f32,
    /// Height look-ups, as [`crate::Record::fetches`] counts them.
    pub fetches: u32,
    /// Iterations of the loop.
    pub iterations: u32,
}

impl OpticalDepth {
    /// Returns the fraction of the light that is neither absorbed nor scattered (Beer–Lambert); 0 from [`MAX_OPTICAL_DEPTH`] on.
    #[must_use]
    pub fn transmittance(&self) -> f32 {
        if self.value >= MAX_OPTICAL_DEPTH { 0.0 } else { (-self.value).exp() }
    }
}

/// Integrates the extinction along `ray` between two distances: over every stretch below the bilinear surface, each between its
/// exact crossings, in closed form in each cell. The ray may begin below the surface, and cross it any number of times.
///
/// Cells in blocks that the ray passes above are left out by the max pyramid. Ends for every input: rays that are not finite
/// have no optical depth, and behind 65536 cells there is none.
#[must_use]
pub fn optical_depth(field: &impl HeightField, ray: &MediumRay, range: [f32; 2], medium: &Medium) -> OpticalDepth {
    if !(ray.is_usable(field.size(), range) && medium.density > 0.0) {
        return OpticalDepth::default();
    }
    let line = ray.line();
    let mut value = 0.0;
    let (end, cost) = visit_cells_near(field, &line, range[0], range[1], |cell| {
        if !cell.is_passed_above() {
            value += medium.density * CellLayer::new(cell, &line, medium.softness).integral();
        }
        (value >= MAX_OPTICAL_DEPTH).then_some(cell.t_exit)
    });
    if matches!(end, SurfaceCrossing::At(_)) {
        value = MAX_OPTICAL_DEPTH;
    }
    OpticalDepth { value, fetches: cost.fetches, iterations: cost.iterations }
}

/// Finds the distances at which light that comes along `ray` backwards was scattered, one for each element of `distances`: element i
/// of n where the share (i + `offset`)/n of all that is scattered up to `total`, the ray's [`optical_depth`], has been.
///
/// With them the integral of any function over the scattered light is its mean at these points times 1 − transmittance: the midpoint
/// rule for `offset` = 0.5, in [0, 1). Returns the cost as an [`OpticalDepth`] of the same value.
pub fn scatter_distances(
    field: &impl HeightField,
    ray: &MediumRay,
    range: [f32; 2],
    medium: &Medium,
    total: &OpticalDepth,
    offset: f32,
    distances: &mut [f32],
) -> OpticalDepth {
    distances.fill(range[1]);
    if !(ray.is_usable(field.size(), range) && medium.density > 0.0) {
        return OpticalDepth::default();
    }
    let (line, count) = (ray.line(), distances.len());
    let scattered = 1.0 - total.transmittance();
    let target = |i: usize| -(1.0 - scattered * ((i as f32 + offset) / count as f32)).ln();
    let (mut value, mut found) = (0.0, 0);
    let (_, cost) = visit_cells_near(field, &line, range[0], range[1], |cell| {
        if cell.is_passed_above() {
            return None;
        }
        let layer = CellLayer::new(cell, &line, medium.softness);
        let until = value + medium.density * layer.integral();
        while found < count && target(found) <= until {
            distances[found] = cell.s + layer.distance_of((target(found) - value) / medium.density);
            found += 1;
        }
        value = until;
        (found == count).then_some(cell.t_exit)
    });
    OpticalDepth { value: total.value, fetches: cost.fetches, iterations: cost.iterations }
}
