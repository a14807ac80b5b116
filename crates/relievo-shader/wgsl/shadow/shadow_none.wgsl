//! No shadows: `none`.
//!
//! Gives relievo_shadow_none.
//! Needs what height.wgsl needs.
//! #import record
//! #import height

fn relievo_shadow_none(
    field: RelievoHeightField, light: RelievoRay, depth: f32, reach: f32, options: RelievoMarchOptions,
) -> RelievoShadowRecord {
    return RelievoShadowRecord(1.0, 0u, 0u);
}
