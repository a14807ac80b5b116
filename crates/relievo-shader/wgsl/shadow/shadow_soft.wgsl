//! The attenuated shadow of the tutorials: `soft`. The sample deepest below the surface decides, near ones most.
//!
//! Gives relievo_shadow_soft.
//! Needs what height.wgsl needs.
//! #import record
//! #import height

fn relievo_shadow_soft(
    field: RelievoHeightField, light: RelievoRay, depth: f32, light_depth: f32, options: RelievoMarchOptions,
) -> RelievoShadowRecord {
    if !relievo_ray_is_usable(light, field.size) || !(abs(depth) < RELIEVO_HUGE) {
        return RelievoShadowRecord(0.0, 0u, 0u);
    }
    let n = relievo_layer_count(options, light.cos);
    let step = relievo_layered_slope(light, options) / n;
    let limit = relievo_layer_limit(n);
    let layer = depth / n;
    var uv = light.uv - step;
    var z = depth - layer;
    var darkest = 0.0;
    var samples = 0u;
    while z > max(light_depth, 0.0) && samples < limit {
        samples += 1u;
        let surface = 1.0 - relievo_height_sample(field, uv);
        if surface < z {
            darkest = max(darkest, (z - surface) * (1.0 - f32(samples) / n));
        }
        z -= layer;
        uv -= step;
    }
    return RelievoShadowRecord(clamp(1.0 - darkest, 0.0, 1.0), samples, samples);
}
