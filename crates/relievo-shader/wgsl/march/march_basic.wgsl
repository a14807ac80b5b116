//! Parallax mapping (Kaneko et al. 2001): `basic`.
//!
//! Gives relievo_march_basic.
//! Needs what height.wgsl needs.
//! #import one_sample

fn relievo_march_basic(field: RelievoHeightField, ray: RelievoRay, options: RelievoMarchOptions) -> RelievoRecord {
    let fenced = relievo_height_fenced(field, relievo_uv_on_lid(ray.uv, relievo_ray_slope(ray), options), options);
    return relievo_one_sample(fenced, ray, relievo_ray_slope(ray), 1.0 - relievo_lid_offset(options));
}
