//! Parallax mapping without the division by the cosine (Welsh 2004): `offset-limiting`.
//!
//! Gives march_offset_limiting.
//! Needs what height.wgsl needs.
//! #import one_sample

fn march_offset_limiting(field: Field, ray: Ray, how: March) -> Record {
    let fenced = height_fenced(field, uv_on_lid(ray.uv, ray_slope(ray), how), how);
    return one_sample(fenced, ray, ray.sweep, 1.0 - march_rise(how));
}
