//! The attenuated shadow of the tutorials: `soft`. The sample deepest below the surface decides, near ones most.
//!
//! Gives shadow_soft.
//! Needs what height.wgsl needs.
//! #import record
//! #import height

fn shadow_soft(field: Field, light: Ray, depth: f32, how: March) -> ShadowRecord {
    if !ray_is_usable(light, field.size) || !(abs(depth) < HUGE) {
        return ShadowRecord(0.0, 0u, 0u);
    }
    let n = march_layers(how, light.cos);
    let step = layered_slope(light, how) / n;
    let limit = layer_limit(n);
    let layer = depth / n;
    var uv = light.uv - step;
    var z = depth - layer;
    var darkest = 0.0;
    var samples = 0u;
    while z > 0.0 && samples < limit {
        samples += 1u;
        let surface = 1.0 - height_sample(field, uv);
        if surface < z {
            darkest = max(darkest, (z - surface) * (1.0 - f32(samples) / n));
        }
        z -= layer;
        uv -= step;
    }
    return ShadowRecord(clamp(1.0 - darkest, 0.0, 1.0), samples, samples);
}
