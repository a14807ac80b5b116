//! The layers between a point and a light: the walk of the tutorials' two shadows.
//!
//! Gives relievo_shadow_by_layers.
//! Needs what height.wgsl needs.
//! #import record
//! #import height

// Counts the layers below the surface (`counts`: hard), or takes the strongest occluder, weighted by its distance (soft).
fn relievo_shadow_by_layers(
    field: RelievoHeightField, light: RelievoRay, depth: f32, reach: f32, options: RelievoMarchOptions, counts: bool,
) -> RelievoShadowRecord {
    let is_usable = relievo_ray_is_usable(light, field.size);
    if !(abs(depth) < RELIEVO_HUGE) || !(is_usable || relievo_light_is_beside(light, reach, field.size)) {
        // Behind the surface the counting shadow leaves the light to the shading.
        return RelievoShadowRecord(select(0.0, 1.0, counts), 0u, 0u);
    }
    if !is_usable {
        return relievo_shadow_by_layers_sideways(field, light, depth, reach, options, counts);
    }
    let light_depth = depth - reach * light.cos;
    let n = relievo_layer_count(options, light.cos);
    let step = relievo_layered_slope(light, options) / n;
    let limit = relievo_layer_limit(n);
    let layer = select(depth, 1.0, counts) / n;
    var uv = light.uv - step;
    var z = depth - layer;
    var below = 0u;
    var darkest = 0.0;
    var samples = 0u;
    while z > max(light_depth, 0.0) && samples < limit {
        samples += 1u;
        let surface = 1.0 - relievo_height_sample(field, uv);
        below += select(0u, 1u, surface <= z);
        if surface < z {
            darkest = max(darkest, (z - surface) * (1.0 - f32(samples) / n));
        }
        z -= layer;
        uv -= step;
    }
    return relievo_shadow_of_layers(select(darkest, f32(below) / n, counts), samples);
}

// To a lamp that lies as low as the point or lower: the way to it is the parameter, not the height.
fn relievo_shadow_by_layers_sideways(
    field: RelievoHeightField, light: RelievoRay, depth: f32, reach: f32, options: RelievoMarchOptions, counts: bool,
) -> RelievoShadowRecord {
    let n = relievo_layer_count(options, 0.0);
    let count = u32(ceil(n));
    let path = light.uv_delta * reach;
    var below = 0u;
    var darkest = 0.0;
    for (var i = 1u; i < count; i++) {
        let t = f32(i) / n;
        let z = depth - light.cos * reach * t;
        let surface = 1.0 - relievo_height_sample(field, light.uv - path * t);
        // A lamp on the plane of a flat surface lights it.
        if surface < z {
            below += 1u;
            darkest = max(darkest, (z - surface) * (1.0 - t));
        }
    }
    return relievo_shadow_of_layers(select(darkest, f32(below) / n, counts), max(count, 1u) - 1u);
}

fn relievo_shadow_of_layers(shade: f32, samples: u32) -> RelievoShadowRecord {
    return RelievoShadowRecord(clamp(1.0 - shade, 0.0, 1.0), samples, samples);
}
