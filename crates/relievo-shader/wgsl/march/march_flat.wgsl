//! No relief: the techniques `none` and `normal`, which differ in the normal alone.
//!
//! Gives march_flat.
//! Needs what height.wgsl needs.
//! #import record
//! #import height

fn march_flat(field: Field, ray: Ray, how: March) -> Record {
    return Record(ray.uv, march_rise(how), true, 0u, 0u);
}
