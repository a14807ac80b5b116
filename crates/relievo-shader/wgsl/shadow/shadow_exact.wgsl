//! The shadow of the bilinear surface itself: `exact`. Through the pyramid up to the top; all of the light arrives, or none.
//!
//! Gives shadow_exact.
//! Needs what descent.wgsl needs.
//! #import descent

// How far above the surface a shadow ray starts, as a fraction of the full depth. On an 8-bit map it starts one step
// higher still, or every slope would throw shadows from the edges of its terraces.
const LIFT: f32 = 1e-4;

fn shadow_exact(field: Field, light: Ray, depth: f32, how: March) -> ShadowRecord {
    if !ray_is_usable(light, field.size) || !(abs(depth) < HUGE) {
        return ShadowRecord(0.0, 0u, 0u);
    }
    // An approximate technique may have stopped below the surface; the shadow starts on it.
    let height = max(1.0 - depth, height_sample(field, light.uv)) + LIFT + field.step;
    let slope = ray_slope(light);
    var end = field.range.y - height;
    if how.bounded != 0u {
        for (var k = 0u; k < 2u; k++) {
            let room = select(how.bounds[k + 2u] - light.uv[k], light.uv[k] - how.bounds[k], slope[k] > 0.0);
            if slope[k] != 0.0 {
                end = min(end, room / abs(slope[k]));
            }
        }
    }
    if end <= 0.0 {
        return ShadowRecord(1.0, 1u, 0u);
    }
    let walk = first_crossing(field, Line(light.uv, -slope, height, 1.0), 0.0, end);
    return ShadowRecord(select(1.0, 0.0, walk.hit), walk.fetches + 1u, walk.turns);
}
