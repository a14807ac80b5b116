//! The first intersection with the bilinear surface: `exact`. No steps, no settings, no misses.
//!
//! Gives march_exact.
//! Needs what height.wgsl needs.
//! #import walk

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

fn march_exact(field: Field, ray: Ray, how: March) -> Record {
    let slope = ray_slope(ray);
    let uv = uv_on_lid(ray.uv, slope, how);
    let fenced = height_fenced(field, uv, how);
    // Above the highest texel there is nothing to hit, and at the lowest one everything has been hit.
    let lowest = 1.0 - field.range.x;
    let inside = depths_inside(uv, slope, how);
    let start = max(1.0 - field.range.y, inside.x);
    let end = min(lowest, inside.y);
    if !(start <= end) {
        return record_miss(ray, 0u, 0u);
    }
    // It comes in from the side: below the surface already, it sees the relief from behind.
    if inside.x > 0.0 && start >= 1.0 - height_sample(fenced, uv + slope * start) {
        return record_miss(ray, 1u, 1u);
    }
    let walk = walk_to_crossing(field, Line(uv, slope, 1.0, -1.0), start, end);
    // Rounding may leave the ray a hair above the floor.
    if walk.hit || (walk.finished && end == lowest) {
        return Record(uv + slope * walk.s, walk.s, true, walk.cells, walk.cells);
    }
    return record_miss(ray, walk.cells, walk.cells);
}
