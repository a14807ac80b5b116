//! Bisection of the whole depth (after Policarpo et al. 2005): `binary`, wrong where the ray crosses the surface twice.
//!
//! Gives march_binary.
//! Needs what height.wgsl needs.
//! #import record
//! #import height
//! #import bounds

fn march_binary(field: Field, ray: Ray, how: March) -> Record {
    let slope = ray_slope(ray);
    let uv = uv_on_lid(ray.uv, slope, how);
    if is_beside(uv, how) && enters_below(field, uv, slope, how) {
        return record_miss(ray, 1u, 1u);
    }
    let fenced = height_fenced(field, uv, how);
    let steps = min(how.refine_steps, MAX_REFINE_STEPS);
    var above = 0.0;
    var below = 1.0;
    for (var k = 0u; k < steps; k++) {
        let middle = 0.5 * (above + below);
        if middle >= 1.0 - height_sample(fenced, uv + slope * middle) {
            below = middle;
        } else {
            above = middle;
        }
    }
    let t = 0.5 * (above + below);
    return Record(uv + slope * t, t, true, steps, steps);
}
