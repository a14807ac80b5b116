//! The shadow of the bilinear surface itself: `exact`. Through the pyramid up to the top; all of the light arrives, or none.
//!
//! Gives relievo_shadow_exact.
//! Needs what descent.wgsl needs.
//! #import descent

// How far above the surface a shadow ray starts, as a fraction of the full depth. On an 8-bit map it starts one step
// higher still, or every slope would throw shadows from the edges of its terraces.
const RELIEVO_SHADOW_LIFT: f32 = 1e-4;

fn relievo_shadow_exact(
    field: RelievoHeightField, light: RelievoRay, depth: f32, light_depth: f32, options: RelievoMarchOptions,
) -> RelievoShadowRecord {
    if !relievo_ray_is_usable(light, field.size) || !(abs(depth) < RELIEVO_HUGE) {
        return RelievoShadowRecord(0.0, 0u, 0u);
    }
    // An approximate technique may have stopped below the surface; the shadow starts on it.
    let height = max(1.0 - depth, relievo_height_sample(field, light.uv)) + RELIEVO_SHADOW_LIFT + field.step;
    let slope = relievo_ray_slope(light);
    var end = min(field.range.y, 1.0 - light_depth) - height;
    if options.bounded != 0u {
        for (var k = 0u; k < 2u; k++) {
            let room = select(options.bounds[k + 2u] - light.uv[k], light.uv[k] - options.bounds[k], slope[k] > 0.0);
            if slope[k] != 0.0 {
                end = min(end, room / abs(slope[k]));
            }
        }
    }
    if end <= 0.0 {
        return RelievoShadowRecord(1.0, 1u, 0u);
    }
    let walk = relievo_first_crossing(field, RelievoHeightLine(light.uv, -slope, height, 1.0), 0.0, end);
    return RelievoShadowRecord(select(1.0, 0.0, walk.hit), walk.fetches + 1u, walk.iterations);
}
