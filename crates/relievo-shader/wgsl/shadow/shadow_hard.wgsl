//! The counting shadow of the tutorials: `hard`. Each layer below the surface takes its part of the light.
//!
//! Gives shadow_hard.
//! Needs what height.wgsl needs.
//! #import record
//! #import height

fn shadow_hard(field: Field, light: Ray, depth: f32, how: March) -> ShadowRecord {
    // Behind the surface this shadow leaves the light to the shading.
    if !ray_is_usable(light, field.size) || !(abs(depth) < HUGE) {
        return ShadowRecord(1.0, 0u, 0u);
    }
    let n = march_layers(how, light.cos);
    let step = layered_slope(light, how) / n;
    let limit = layer_limit(n);
    var uv = light.uv - step;
    var z = depth - 1.0 / n;
    var below = 0u;
    var samples = 0u;
    while z > 0.0 && samples < limit {
        samples += 1u;
        below += select(0u, 1u, 1.0 - height_sample(field, uv) <= z);
        z -= 1.0 / n;
        uv -= step;
    }
    return ShadowRecord(clamp(1.0 - f32(below) / n, 0.0, 1.0), samples, samples);
}
