use crate::cost::MAX_CELLS;
use crate::exact::{SurfaceCrossing, first_crossing};
use crate::grid_line::Line;
use crate::{HeightField, MarchOptions, Ray, Shadow};

/// The distance above the surface at which an exact shadow ray starts, as a fraction of the full depth: hits are known to
/// about 1e-6.
/// On an 8-bit map it starts one step higher still, or every slope would throw shadows from the edges of its terraces.
const LIFT: f32 = 1e-4;

/// The most that a lamp may lie below the point, in full depths: one that is farther down lies below all of the relief.
const MAX_DESCENT: f32 = 4.0;

/// The part of a light that reaches a point of the relief, and the cost of the march.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowRecord {
    /// Factor on the light's diffuse and specular part: 0 = none, 1 = all of it.
    pub factor: f32,
    /// Height look-ups: filtered samples, or for [`Shadow::Exact`] nodes of the max pyramid and gathers of four corners.
    pub fetches: u32,
    /// Iterations of the loop.
    pub iterations: u32,
}

/// Marches from a point of the relief (`light.uv`, at `depth`) towards a light.
///
/// `light.uv_delta` and `light.cos` are those of a ray that comes *from* the light, built from L as a view ray is from V.
/// The kinds: the tutorials' counting shadow ([`Shadow::Hard`]) and attenuated shadow ([`Shadow::Soft`]), and
/// [`Shadow::Exact`], which follows the bilinear surface up to its top, through the max pyramid where the field has one.
/// Only the layer counts, `offset_limiting` and `bounds` of `options` are used. Ends for every input.
#[must_use]
pub fn shadow(field: &impl HeightField, kind: Shadow, light: &Ray, depth: f32, options: &MarchOptions) -> ShadowRecord {
    shadow_up_to(field, kind, light, depth, f32::INFINITY, options)
}

/// Marches as [`shadow`] does, but only as far as the light is, at the distance `reach` in full depths: nothing beyond hides
/// a lamp that hangs among the relief, which may also lie lower than the point. A directional light is infinitely far.
#[must_use]
pub fn shadow_up_to(
    field: &impl HeightField,
    kind: Shadow,
    light: &Ray,
    depth: f32,
    reach: f32,
    options: &MarchOptions,
) -> ShadowRecord {
    let unmarched = |factor| ShadowRecord { factor, fetches: 0, iterations: 0 };
    // Behind the surface the tutorials' two shadows disagree: the counting one leaves the light to the shading.
    let behind = match kind {
        Shadow::None => return unmarched(1.0),
        Shadow::Hard => 1.0,
        Shadow::Soft | Shadow::Exact => 0.0,
    };
    if !depth.is_finite() {
        return unmarched(behind);
    }
    if !light.is_usable(field.size()) {
        let reaches = Ray { cos: 1.0, uv_delta: light.uv_delta.map(|d| d * reach), ..*light }.is_usable(field.size());
        let sideways = reaches && light.cos.abs() <= 1.0 && reach > 0.0 && light.cos * reach > -MAX_DESCENT;
        return if sideways { sideways_shadow(field, kind, light, depth, reach, options) } else { unmarched(behind) };
    }
    let light_depth = depth - reach * light.cos;
    match kind {
        Shadow::None => unmarched(1.0),
        Shadow::Hard | Shadow::Soft => layered_shadow(field, kind, light, depth, light_depth, options),
        Shadow::Exact => any_hit(field, light, depth, light_depth, options),
    }
}

/// Marches to a lamp that lies as low as the point or lower: the way to it is the parameter, not the height.
fn sideways_shadow(
    field: &impl HeightField,
    kind: Shadow,
    light: &Ray,
    depth: f32,
    reach: f32,
    options: &MarchOptions,
) -> ShadowRecord {
    let [u, v] = light.uv_delta.map(|d| d * reach);
    if kind == Shadow::Exact {
        let height = lifted_height(field, light.uv, depth);
        let line = Line { uv: light.uv, slope: [-u, -v], height, dheight_ds: light.cos * reach };
        let end = end_in_bounds(options, light.uv, [u, v], 1.0);
        return any_crossing(field, &line, end);
    }
    let mut layers = ShadowLayers::new(kind, options.layers(0.0));
    for i in 1..layers.n.ceil() as u32 {
        let t = i as f32 / layers.n;
        let z = depth - light.cos * reach * t;
        let surface = 1.0 - field.sample([light.uv[0] - u * t, light.uv[1] - v * t]);
        // A lamp on the plane of a flat surface lights it.
        layers.add(z, surface, surface < z);
    }
    layers.record()
}

/// Marches in layers up to the lid, or up to the light below it: the tutorials' two shadows.
fn layered_shadow(
    field: &impl HeightField,
    kind: Shadow,
    light: &Ray,
    depth: f32,
    light_depth: f32,
    options: &MarchOptions,
) -> ShadowRecord {
    let mut layers = ShadowLayers::new(kind, options.layers(light.cos));
    let (n, limit) = (layers.n, layers.n.ceil() as u32 + 1);
    let layer = if kind == Shadow::Hard { 1.0 / n } else { depth / n };
    let step = options.layered_slope(light).map(|s| s / n);
    let mut uv = [light.uv[0] - step[0], light.uv[1] - step[1]];
    let mut z = depth - layer;
    while z > light_depth.max(0.0) && layers.samples < limit {
        let surface = 1.0 - field.sample(uv);
        layers.add(z, surface, surface <= z);
        z -= layer;
        uv = [uv[0] - step[0], uv[1] - step[1]];
    }
    layers.record()
}

/// The layers between a point and a light, as the tutorials' two shadows add them up.
struct ShadowLayers {
    kind: Shadow,
    n: f32,
    samples: u32,
    below: u32,
    darkest: f32,
}

impl ShadowLayers {
    fn new(kind: Shadow, n: f32) -> Self {
        Self { kind, n, samples: 0, below: 0, darkest: 0.0 }
    }

    /// Adds the next layer, at depth `z`, where the surface is this deep.
    #[inline]
    fn add(&mut self, z: f32, surface: f32, is_below: bool) {
        self.samples += 1;
        self.below += u32::from(is_below);
        if surface < z {
            self.darkest = self.darkest.max((z - surface) * (1.0 - self.samples as f32 / self.n));
        }
    }

    /// Counts the layers below the surface (hard), or takes the strongest occluder, weighted by its distance (soft).
    fn record(&self) -> ShadowRecord {
        let shade = if self.kind == Shadow::Hard { self.below as f32 / self.n } else { self.darkest };
        let samples = self.samples;
        ShadowRecord { factor: (1.0 - shade).clamp(0.0, 1.0), fetches: samples, iterations: samples }
    }
}

/// Finds any hit of the exact march on the way to the light.
fn any_hit(
    field: &impl HeightField,
    light: &Ray,
    depth: f32,
    light_depth: f32,
    options: &MarchOptions,
) -> ShadowRecord {
    let slope = light.slope();
    let height = lifted_height(field, light.uv, depth);
    let line = Line { uv: light.uv, slope: slope.map(|s| -s), height, dheight_ds: 1.0 };
    let end = field.range()[1].min(1.0 - light_depth) - height;
    any_crossing(field, &line, end_in_bounds(options, light.uv, slope, end))
}

/// Returns the height at which an exact shadow ray starts. An approximate technique may have stopped below the surface; the
/// shadow starts on it.
fn lifted_height(field: &impl HeightField, uv: [f32; 2], depth: f32) -> f32 {
    (1.0 - depth).max(field.sample(uv)) + LIFT + field.quantization_step()
}

/// Returns where a line that goes against `slope` leaves the bounds, if it does before `end`.
fn end_in_bounds(options: &MarchOptions, uv: [f32; 2], slope: [f32; 2], mut end: f32) -> f32 {
    let Some(bounds) = options.bounds else { return end };
    for k in 0..2 {
        let room = if slope[k] > 0.0 { uv[k] - bounds.min[k] } else { bounds.max[k] - uv[k] };
        if slope[k] != 0.0 {
            end = end.min(room / slope[k].abs());
        }
    }
    end
}

/// Asks whether the surface is crossed before `end`.
fn any_crossing(field: &impl HeightField, line: &Line<f32>, end: f32) -> ShadowRecord {
    if end <= 0.0 {
        return ShadowRecord { factor: 1.0, fetches: 1, iterations: 0 };
    }
    let (crossing, cost) = first_crossing(field, line, 0.0, end, MAX_CELLS);
    let factor = if matches!(crossing, SurfaceCrossing::At(_)) { 0.0 } else { 1.0 };
    ShadowRecord { factor, fetches: cost.fetches + 1, iterations: cost.iterations }
}
