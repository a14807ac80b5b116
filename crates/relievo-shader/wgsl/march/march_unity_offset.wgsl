//! The parallax offset of Unity's built-in shaders: `unity-offset`. Half of the range lies above the polygon, whatever the
//! material says, and the cosine is raised by 0.42.
//!
//! Gives march_unity_offset.
//! Needs what height.wgsl needs.
//! #import one_sample

fn march_unity_offset(field: Field, ray: Ray, how: March) -> Record {
    let fenced = height_fenced(field, uv_on_lid(ray.uv, ray_slope(ray), how), how);
    return one_sample(fenced, ray, ray.sweep / (ray.cos + 0.42), 0.5);
}
