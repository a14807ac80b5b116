//! The parallax offset of Unity's built-in shaders: `unity-offset`. Half of the range lies above the polygon, whatever the
//! material says, and the cosine is raised by 0.42.
//!
//! Gives relievo_march_unity_offset.
//! Needs what height.wgsl needs.
//! #import one_sample

fn relievo_march_unity_offset(field: RelievoHeightField, ray: RelievoRay, options: RelievoMarchOptions) -> RelievoRecord {
    let fenced = relievo_height_fenced(field, relievo_uv_on_lid(ray.uv, relievo_ray_slope(ray), options), options);
    return relievo_one_sample(fenced, ray, ray.uv_delta / (ray.cos + 0.42), 0.5);
}
