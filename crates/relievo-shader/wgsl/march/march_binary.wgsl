//! Bisection of the whole depth (after Policarpo et al. 2005): `binary`, wrong where the ray crosses the surface twice.
//!
//! Gives relievo_march_binary.
//! Needs what height.wgsl needs.
//! #import record
//! #import height
//! #import bounds

fn relievo_march_binary(field: RelievoHeightField, ray: RelievoRay, options: RelievoMarchOptions) -> RelievoRecord {
    let slope = relievo_ray_slope(ray);
    let uv = relievo_uv_on_lid(ray.uv, slope, options);
    if relievo_is_beside(uv, options) && relievo_enters_below(field, uv, slope, options) {
        return relievo_miss(ray, 1u, 1u);
    }
    let fenced = relievo_height_fenced(field, uv, options);
    let steps = min(options.refine_steps, RELIEVO_MAX_REFINE_STEPS);
    var above = 0.0;
    var below = 1.0;
    for (var k = 0u; k < steps; k++) {
        let middle = 0.5 * (above + below);
        if middle >= 1.0 - relievo_height_sample(fenced, uv + slope * middle) {
            below = middle;
        } else {
            above = middle;
        }
    }
    let t = 0.5 * (above + below);
    return RelievoRecord(uv + slope * t, t, true, steps, steps);
}
