//! The shadow of the bilinear surface itself: `exact`. Through the pyramid up to the top; all of the light arrives, or none.
//!
//! Gives relievo_shadow_exact.
//! Needs what descent.wgsl needs.
//! #import descent

// How far above the surface a shadow ray starts, as a fraction of the full depth. On an 8-bit map it starts one step
// higher still, or every slope would throw shadows from the edges of its terraces.
const RELIEVO_SHADOW_LIFT: f32 = 1e-4;

fn relievo_shadow_exact(
    field: RelievoHeightField, light: RelievoRay, depth: f32, reach: f32, options: RelievoMarchOptions,
) -> RelievoShadowRecord {
    if !(abs(depth) < RELIEVO_HUGE) {
        return RelievoShadowRecord(0.0, 0u, 0u);
    }
    if !relievo_ray_is_usable(light, field.size) {
        if relievo_light_is_beside(light, reach, field.size) {
            return relievo_shadow_exact_sideways(field, light, depth, reach, options);
        }
        return RelievoShadowRecord(0.0, 0u, 0u);
    }
    let light_depth = depth - reach * light.cos;
    // An approximate technique may have stopped below the surface; the shadow starts on it.
    let height = max(1.0 - depth, relievo_height_sample(field, light.uv)) + RELIEVO_SHADOW_LIFT + field.step;
    let slope = relievo_ray_slope(light);
    let end = min(field.range.y, 1.0 - light_depth) - height;
    return relievo_shadow_crossing(
        field, RelievoHeightLine(light.uv, -slope, height, 1.0), relievo_shadow_end(light.uv, slope, end, options));
}

// To a lamp that lies as low as the point or lower: the way to it is the parameter, not the height.
fn relievo_shadow_exact_sideways(
    field: RelievoHeightField, light: RelievoRay, depth: f32, reach: f32, options: RelievoMarchOptions,
) -> RelievoShadowRecord {
    let height = max(1.0 - depth, relievo_height_sample(field, light.uv)) + RELIEVO_SHADOW_LIFT + field.step;
    let path = light.uv_delta * reach;
    return relievo_shadow_crossing(
        field, RelievoHeightLine(light.uv, -path, height, light.cos * reach), relievo_shadow_end(light.uv, path, 1.0, options));
}

// Where a line that goes against `slope` leaves the bounds, if it does before `end`.
fn relievo_shadow_end(uv: vec2f, slope: vec2f, end: f32, options: RelievoMarchOptions) -> f32 {
    var nearest = end;
    if options.bounded != 0u {
        for (var k = 0u; k < 2u; k++) {
            let room = select(options.bounds[k + 2u] - uv[k], uv[k] - options.bounds[k], slope[k] > 0.0);
            if slope[k] != 0.0 {
                nearest = min(nearest, room / abs(slope[k]));
            }
        }
    }
    return nearest;
}

// Whether the surface is crossed before `end`.
fn relievo_shadow_crossing(field: RelievoHeightField, line: RelievoHeightLine, end: f32) -> RelievoShadowRecord {
    if end <= 0.0 {
        return RelievoShadowRecord(1.0, 1u, 0u);
    }
    let walk = relievo_first_crossing(field, line, 0.0, end);
    return RelievoShadowRecord(select(1.0, 0.0, walk.hit), walk.fetches + 1u, walk.iterations);
}
