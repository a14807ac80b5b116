//! Parallax mapping (Kaneko et al. 2001): `basic`.
//!
//! Gives march_basic.
//! Needs what height.wgsl needs.
//! #import one_sample

fn march_basic(field: Field, ray: Ray, how: March) -> Record {
    let fenced = height_fenced(field, uv_on_lid(ray.uv, ray_slope(ray), how), how);
    return one_sample(fenced, ray, ray_slope(ray), 1.0 - march_rise(how));
}
