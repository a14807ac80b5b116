//! Where a ray comes into the bounds of its surface, and leaves them.
//!
//! Gives is_beside, depths_inside, enters_below.
//! Needs what height.wgsl needs.
//! #import record
//! #import height

// Whether a ray whose lid lies above its polygon crosses it beside the surface.
fn is_beside(uv: vec2f, how: March) -> bool {
    return how.bounded != 0u && march_rise(how) > 0.0 && !in_bounds(how.bounds, uv);
}

// The depths at which the ray comes into the bounds (not above the lid) and leaves them.
fn depths_inside(uv: vec2f, slope: vec2f, how: March) -> vec2f {
    var enter = 0.0;
    var exit = HUGE;
    if how.bounded == 0u {
        return vec2f(enter, exit);
    }
    for (var k = 0u; k < 2u; k++) {
        let low = how.bounds[k];
        let high = how.bounds[k + 2u];
        let outside = uv[k] < low || uv[k] > high;
        if slope[k] == 0.0 {
            if outside {
                return vec2f(HUGE, 0.0);
            }
            continue;
        }
        let near = select(high, low, slope[k] > 0.0);
        let far = select(low, high, slope[k] > 0.0);
        exit = min(exit, (far - uv[k]) / slope[k]);
        // Rounding must not bring a ray that is inside from the start in from the side.
        if outside {
            enter = max(enter, (near - uv[k]) / slope[k]);
        }
    }
    return vec2f(enter, exit);
}

// Whether a ray that comes into its bounds from the side is below the surface there: it sees the relief from behind.
fn enters_below(field: Field, uv: vec2f, slope: vec2f, how: March) -> bool {
    let inside = depths_inside(uv, slope, how);
    if !(inside.x <= inside.y) {
        return true;
    }
    return inside.x > 0.0 && inside.x >= 1.0 - height_sample(field, uv + slope * inside.x);
}
