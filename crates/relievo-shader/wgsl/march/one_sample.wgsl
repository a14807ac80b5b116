//! One sample where the ray meets the polygon, one step: what the plain parallax techniques share.
//!
//! Gives one_sample.
//! Needs what height.wgsl needs.
//! #import record
//! #import height

// `offset` is the way in uv per unit of depth below the height `level`.
fn one_sample(field: Field, ray: Ray, offset: vec2f, level: f32) -> Record {
    let height = height_sample(field, ray.uv);
    return Record(ray.uv + offset * (level - height), 1.0 - height, true, 1u, 1u);
}
