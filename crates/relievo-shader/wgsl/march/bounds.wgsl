//! Where a ray comes into the bounds of its surface, and leaves them.
//!
//! Gives relievo_is_beside, relievo_depths_inside, relievo_enters_below.
//! Needs what height.wgsl needs.
//! #import record
//! #import height

// Whether a ray whose lid lies above its polygon crosses it beside the surface.
fn relievo_is_beside(uv: vec2f, options: RelievoMarchOptions) -> bool {
    return options.bounded != 0u && relievo_lid_offset(options) > 0.0 && !relievo_in_bounds(options.bounds, uv);
}

// The depths at which the ray comes into the bounds (not above the lid) and leaves them.
fn relievo_depths_inside(uv: vec2f, slope: vec2f, options: RelievoMarchOptions) -> vec2f {
    var enter = 0.0;
    var exit = RELIEVO_HUGE;
    if options.bounded == 0u {
        return vec2f(enter, exit);
    }
    for (var k = 0u; k < 2u; k++) {
        let low = options.bounds[k];
        let high = options.bounds[k + 2u];
        let outside = uv[k] < low || uv[k] > high;
        if slope[k] == 0.0 {
            if outside {
                return vec2f(RELIEVO_HUGE, 0.0);
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
fn relievo_enters_below(field: RelievoHeightField, uv: vec2f, slope: vec2f, options: RelievoMarchOptions) -> bool {
    let inside = relievo_depths_inside(uv, slope, options);
    if !(inside.x <= inside.y) {
        return true;
    }
    return inside.x > 0.0 && inside.x >= 1.0 - relievo_height_sample(field, uv + slope * inside.x);
}
