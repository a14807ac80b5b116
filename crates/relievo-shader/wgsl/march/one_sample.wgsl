//! One sample where the ray meets the polygon, one step: what the plain parallax techniques share.
//!
//! Gives relievo_one_sample.
//! Needs what height.wgsl needs.
//! #import record
//! #import height

// `offset` is the way in uv per unit of depth below the height `level`.
fn relievo_one_sample(field: RelievoHeightField, ray: RelievoRay, offset: vec2f, level: f32) -> RelievoRecord {
    let height = relievo_height_sample(field, ray.uv);
    return RelievoRecord(ray.uv + offset * (level - height), 1.0 - height, true, 1u, 1u);
}
