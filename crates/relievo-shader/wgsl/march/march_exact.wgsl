//! The first intersection with the bilinear surface: `exact`. No steps, no settings, no misses.
//!
//! Gives march_exact.
//! Needs what descent.wgsl needs.
//! #import bounds
//! #import descent

// The ray is known to stay above the surface down to the depth `entry`.
fn march_exact(field: Field, ray: Ray, how: March, entry: f32) -> Record {
    let slope = ray_slope(ray);
    let uv = uv_on_lid(ray.uv, slope, how);
    // Above the highest texel there is nothing to hit, and at the lowest one everything has been hit.
    let lowest = 1.0 - field.range.x;
    let inside = depths_inside(uv, slope, how);
    let start = max(max(1.0 - field.range.y, inside.x), entry);
    let end = min(lowest, inside.y);
    if !(start <= end) {
        return record_miss(ray, 0u, 0u);
    }
    if enters_below(field, uv, slope, how) {
        return record_miss(ray, 1u, 1u);
    }
    let walk = first_crossing(field, Line(uv, slope, 1.0, -1.0), start, end);
    // A walk that was cut off has its hit where it is then; rounding may leave the ray a hair above the floor.
    if walk.hit || !walk.finished || end == lowest {
        return Record(uv + slope * walk.s, walk.s, true, walk.fetches, walk.turns);
    }
    return record_miss(ray, walk.fetches, walk.turns);
}
