//! The attenuated shadow of the tutorials: `soft`. The sample deepest below the surface decides, near ones most.
//!
//! Gives relievo_shadow_soft.
//! Needs what height.wgsl needs.
//! #import shadow_layers

fn relievo_shadow_soft(
    field: RelievoHeightField, light: RelievoRay, depth: f32, reach: f32, options: RelievoMarchOptions,
) -> RelievoShadowRecord {
    return relievo_shadow_by_layers(field, light, depth, reach, options, false);
}
