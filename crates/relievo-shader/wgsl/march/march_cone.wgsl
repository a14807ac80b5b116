//! Cone stepping: `cone`, through relaxed cones and finished by bisection (Policarpo and Oliveira 2007), or through
//! conservative ones and finished by the exact walk (Dummer 2006).
//!
//! Gives march_cone.
//! Needs what cone.wgsl needs.
//! #import bounds
//! #import cone

fn march_cone(field: Field, ray: Ray, how: March) -> Record {
    let slope = ray_slope(ray);
    let uv = uv_on_lid(ray.uv, slope, how);
    // Above the highest texel there is nothing to hit, and at the lowest one everything has been hit.
    let lowest = 1.0 - field.range.x;
    let inside = depths_inside(uv, slope, how);
    let start = max(1.0 - field.range.y, inside.x);
    let end = min(lowest, inside.y);
    if !(start <= end) {
        return record_miss(ray, 0u, 0u);
    }
    if enters_below(field, uv, slope, how) {
        return record_miss(ray, 1u, 1u);
    }
    let walk = cone_crossing(field, Line(uv, slope, 1.0, -1.0), start, end, how);
    // A march that was cut off has its hit where it is then; rounding may leave the ray a hair above the floor.
    if walk.hit || !walk.finished || end == lowest {
        return Record(uv + slope * walk.s, walk.s, true, walk.fetches, walk.turns);
    }
    return record_miss(ray, walk.fetches, walk.turns);
}
