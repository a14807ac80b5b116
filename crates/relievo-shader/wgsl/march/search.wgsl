//! The linear search in layers that the approximate techniques share.
//!
//! Gives RelievoLayerCrossing, relievo_linear_search, relievo_search_layers, relievo_search_field,
//! relievo_enters_from_behind, relievo_crossing_record.
//! Needs what height.wgsl needs.
//! #import record
//! #import height
//! #import bounds

// Where a linear search went below the surface.
struct RelievoLayerCrossing {
    // The sample below (or on) the surface, its layer's depth, and D there.
    uv: vec2f,
    t: f32,
    surface: f32,
    // The uv travelled per layer, and one layer.
    step: vec2f,
    layer: f32,
    samples: u32,
}

// Goes down from `uv`, at depth `t`, in layers of depth `layer`, to the first sample that lies below the surface.
fn relievo_linear_search(
    field: RelievoHeightField, uv: vec2f, t: f32, slope: vec2f, layer: f32, max_steps: u32,
) -> RelievoLayerCrossing {
    let step = slope * layer;
    var found = RelievoLayerCrossing(uv, t, 1.0 - relievo_height_sample(field, uv), step, layer, 1u);
    while found.t < found.surface && found.samples <= max_steps {
        found.uv += step;
        found.surface = 1.0 - relievo_height_sample(field, found.uv);
        found.t += layer;
        found.samples += 1u;
    }
    return found;
}

// The first layer of the whole depth that lies below the surface; the ray is the one through the polygon.
fn relievo_search_layers(field: RelievoHeightField, ray: RelievoRay, options: RelievoMarchOptions) -> RelievoLayerCrossing {
    let n = relievo_layer_count(options, ray.cos);
    let slope = relievo_layered_slope(ray, options);
    return relievo_linear_search(
        field, relievo_uv_on_lid(ray.uv, slope, options), 0.0, slope, 1.0 / n, relievo_layer_limit(n));
}

// The field of a layered march: fenced where the ray enters beside the surface.
fn relievo_search_field(field: RelievoHeightField, ray: RelievoRay, options: RelievoMarchOptions) -> RelievoHeightField {
    return relievo_height_fenced(field, relievo_uv_on_lid(ray.uv, relievo_layered_slope(ray, options), options), options);
}

// Whether a layered march comes in beside the surface, below it.
fn relievo_enters_from_behind(field: RelievoHeightField, ray: RelievoRay, options: RelievoMarchOptions) -> bool {
    let slope = relievo_layered_slope(ray, options);
    let uv = relievo_uv_on_lid(ray.uv, slope, options);
    return relievo_is_beside(uv, options) && relievo_enters_below(field, uv, slope, options);
}

// The end of a search as the technique's answer.
fn relievo_crossing_record(found: RelievoLayerCrossing, uv: vec2f, t: f32, more_samples: u32) -> RelievoRecord {
    let samples = found.samples + more_samples;
    return RelievoRecord(uv, clamp(t, 0.0, 1.0), true, samples, samples);
}
