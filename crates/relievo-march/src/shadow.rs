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
/// [`Shadow::Exact`], which follows the bilinear surface up to its top, through the max pyramid where the field has one. Only the layer counts,
/// `offset_limiting` and `bounds` of `options` are used. Ends for every input.
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
        Shadow::Hard => counting(field, light, depth, light_depth, options),
        Shadow::Soft => attenuated(field, light, depth, light_depth, options),
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
    let n = options.layers(0.0);
    let [u, v] = light.uv_delta.map(|d| d * reach);
    if kind == Shadow::Exact {
        let height = (1.0 - depth).max(field.sample(light.uv)) + LIFT + field.quantization_step();
        let line = Line { uv: light.uv, slope: [-u, -v], height, dheight_ds: light.cos * reach };
        let end = end_in_bounds(options, light.uv, [u, v], 1.0);
        return any_crossing(field, &line, end);
    }
    let (mut below, mut darkest, count) = (0u32, 0.0f32, n.ceil() as u32);
    for i in 1..count {
        let t = i as f32 / n;
        let z = depth - light.cos * reach * t;
        let surface = 1.0 - field.sample([light.uv[0] - u * t, light.uv[1] - v * t]);
        if surface < z {
            below += 1;
            darkest = darkest.max((z - surface) * (1.0 - t));
        }
    }
    let shade = if kind == Shadow::Hard { below as f32 / n } else { darkest };
    let samples = count.saturating_sub(1);
    ShadowRecord { factor: (1.0 - shade).clamp(0.0, 1.0), fetches: samples, iterations: samples }
}

/// Samples the layers of a march up to the lid, or up to the light below it: calls `visit(index from 1, layer depth, D)`;
/// returns their number.
fn climb(
    field: &impl HeightField,
    light: &Ray,
    [depth, light_depth]: [f32; 2],
    layer: f32,
    n: f32,
    options: &MarchOptions,
    mut visit: impl FnMut(u32, f32, f32),
) -> u32 {
    let step = options.layered_slope(light).map(|s| s / n);
    let mut uv = [light.uv[0] - step[0], light.uv[1] - step[1]];
    let mut z = depth - layer;
    let (mut samples, limit) = (0, n.ceil() as u32 + 1);
    while z > light_depth.max(0.0) && samples < limit {
        samples += 1;
        visit(samples, z, 1.0 - field.sample(uv));
        z -= layer;
        uv = [uv[0] - step[0], uv[1] - step[1]];
    }
    samples
}

/// Counts the layers below the surface: the tutorials' hard shadow.
fn counting(
    field: &impl HeightField,
    light: &Ray,
    depth: f32,
    light_depth: f32,
    options: &MarchOptions,
) -> ShadowRecord {
    let n = options.layers(light.cos);
    let mut below = 0u32;
    let samples = climb(field, light, [depth, light_depth], 1.0 / n, n, options, |_, z, surface| {
        below += u32::from(surface <= z);
    });
    ShadowRecord { factor: (1.0 - below as f32 / n).clamp(0.0, 1.0), fetches: samples, iterations: samples }
}

/// Finds the strongest occluder, weighted by its distance: the tutorials' soft shadow.
fn attenuated(
    field: &impl HeightField,
    light: &Ray,
    depth: f32,
    light_depth: f32,
    options: &MarchOptions,
) -> ShadowRecord {
    let n = options.layers(light.cos);
    let mut darkest = 0.0f32;
    let samples = climb(field, light, [depth, light_depth], depth / n, n, options, |i, z, surface| {
        if surface < z {
            darkest = darkest.max((z - surface) * (1.0 - i as f32 / n));
        }
    });
    ShadowRecord { factor: (1.0 - darkest).clamp(0.0, 1.0), fetches: samples, iterations: samples }
}

/// Finds any hit of the exact march on the way to the light.
fn any_hit(
    field: &impl HeightField,
    light: &Ray,
    depth: f32,
    light_depth: f32,
    options: &MarchOptions,
) -> ShadowRecord {
    // An approximate technique may have stopped below the surface; the shadow starts on it.
    let height = (1.0 - depth).max(field.sample(light.uv)) + LIFT + field.quantization_step();
    let slope = light.slope();
    let line = Line { uv: light.uv, slope: slope.map(|s| -s), height, dheight_ds: 1.0 };
    let end = field.range()[1].min(1.0 - light_depth) - height;
    any_crossing(field, &line, end_in_bounds(options, light.uv, slope, end))
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
