//! No relief: the techniques `none` and `normal`, which differ in the normal alone.
//!
//! Gives relievo_march_flat.
//! Needs what height.wgsl needs.
//! #import record
//! #import height

fn relievo_march_flat(field: RelievoHeightField, ray: RelievoRay, options: RelievoMarchOptions) -> RelievoRecord {
    return RelievoRecord(ray.uv, relievo_lid_offset(options), true, 0u, 0u);
}
