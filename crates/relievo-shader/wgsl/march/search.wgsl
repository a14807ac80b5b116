//! The linear search in layers that the approximate techniques share.
//!
//! Gives Crossing, linear_search, search_layers, search_field, sees_from_behind, crossing_record.
//! Needs what height.wgsl needs.
//! #import record
//! #import height
//! #import bounds

// Where a linear search went below the surface.
struct Crossing {
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
fn linear_search(field: Field, uv: vec2f, t: f32, slope: vec2f, layer: f32, max_steps: u32) -> Crossing {
    let step = slope * layer;
    var found = Crossing(uv, t, 1.0 - height_sample(field, uv), step, layer, 1u);
    while found.t < found.surface && found.samples <= max_steps {
        found.uv += step;
        found.surface = 1.0 - height_sample(field, found.uv);
        found.t += layer;
        found.samples += 1u;
    }
    return found;
}

// The first layer of the whole depth that lies below the surface; the ray is the one through the polygon.
fn search_layers(field: Field, ray: Ray, how: March) -> Crossing {
    let n = march_layers(how, ray.cos);
    let slope = layered_slope(ray, how);
    return linear_search(field, uv_on_lid(ray.uv, slope, how), 0.0, slope, 1.0 / n, layer_limit(n));
}

// The field of a layered march: fenced where the ray enters beside the surface.
fn search_field(field: Field, ray: Ray, how: March) -> Field {
    return height_fenced(field, uv_on_lid(ray.uv, layered_slope(ray, how), how), how);
}

// Whether a layered march comes in beside the surface, below it.
fn sees_from_behind(field: Field, ray: Ray, how: March) -> bool {
    let slope = layered_slope(ray, how);
    let uv = uv_on_lid(ray.uv, slope, how);
    return is_beside(uv, how) && enters_below(field, uv, slope, how);
}

// The end of a search as the technique's answer.
fn crossing_record(found: Crossing, uv: vec2f, t: f32, more_samples: u32) -> Record {
    let samples = found.samples + more_samples;
    return Record(uv, clamp(t, 0.0, 1.0), true, samples, samples);
}
