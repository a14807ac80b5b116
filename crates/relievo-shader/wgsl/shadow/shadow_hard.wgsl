//! The counting shadow of the tutorials: `hard`. Each layer below the surface takes its part of the light.
//!
//! Gives relievo_shadow_hard.
//! Needs what height.wgsl needs.
//! #import record
//! #import height

fn relievo_shadow_hard(
    field: RelievoHeightField, light: RelievoRay, depth: f32, light_depth: f32, options: RelievoMarchOptions,
) -> RelievoShadowRecord {
    // Behind the surface this shadow leaves the light to the shading.
    if !relievo_ray_is_usable(light, field.size) || !(abs(depth) < RELIEVO_HUGE) {
        return RelievoShadowRecord(1.0, 0u, 0u);
    }
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
