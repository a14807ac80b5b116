//! Parallax mapping without the division by the cosine (Welsh 2004): `offset-limiting`.
//!
//! Gives relievo_march_offset_limiting.
//! Needs what height.wgsl needs.
//! #import one_sample

fn relievo_march_offset_limiting(
    field: RelievoHeightField, ray: RelievoRay, options: RelievoMarchOptions,
) -> RelievoRecord {
    let fenced = relievo_height_fenced(field, relievo_uv_on_lid(ray.uv, relievo_ray_slope(ray), options), options);
    return relievo_one_sample(fenced, ray, ray.uv_delta, 1.0 - relievo_lid_offset(options));
}
