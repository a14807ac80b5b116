//! The counting shadow of the tutorials: `hard`. Each layer below the surface takes its part of the light.
//!
//! Gives relievo_shadow_hard.
//! Needs what height.wgsl needs.
//! #import record
//! #import height

fn relievo_shadow_hard(
    field: RelievoHeightField, light: RelievoRay, depth: f32, reach: f32, options: RelievoMarchOptions,
) -> RelievoShadowRecord {
    // Behind the surface this shadow leaves the light to the shading.
    if !(abs(depth) < RELIEVO_HUGE) {
        return RelievoShadowRecord(1.0, 0u, 0u);
    }
    if !relievo_ray_is_usable(light, field.size) {
        if relievo_light_is_beside(light, reach, field.size) {
            return relievo_shadow_hard_sideways(field, light, depth, reach, options);
        }
        return RelievoShadowRecord(1.0, 0u, 0u);
    }
    let light_depth = depth - reach * light.cos;
    let n = relievo_layer_count(options, light.cos);
    let step = relievo_layered_slope(light, options) / n;
    let limit = relievo_layer_limit(n);
    var uv = light.uv - step;
    var z = depth - 1.0 / n;
    var below = 0u;
    var samples = 0u;
    while z > max(light_depth, 0.0) && samples < limit {
        samples += 1u;
        below += select(0u, 1u, 1.0 - relievo_height_sample(field, uv) <= z);
        z -= 1.0 / n;
        uv -= step;
    }
    return RelievoShadowRecord(clamp(1.0 - f32(below) / n, 0.0, 1.0), samples, samples);
}

// To a lamp that lies as low as the point or lower: the way to it is the parameter, not the height.
fn relievo_shadow_hard_sideways(
    field: RelievoHeightField, light: RelievoRay, depth: f32, reach: f32, options: RelievoMarchOptions,
) -> RelievoShadowRecord {
    let n = relievo_layer_count(options, 0.0);
    let count = u32(ceil(n));
    var shade = 0.0;
    for (var i = 1u; i < count; i++) {
        let t = f32(i) / n;
        let z = depth - light.cos * reach * t;
        let surface = 1.0 - relievo_height_sample(field, light.uv - light.uv_delta * (reach * t));
        if surface < z {
            shade = shade + 1.0 / n;
        }
    }
    let samples = max(count, 1u) - 1u;
    return RelievoShadowRecord(clamp(1.0 - shade, 0.0, 1.0), samples, samples);
}
