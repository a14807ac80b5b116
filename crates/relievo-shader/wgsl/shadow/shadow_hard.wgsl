//! The counting shadow of the tutorials: `hard`. Each layer below the surface takes its part of the light.
//!
//! Gives relievo_shadow_hard.
//! Needs what height.wgsl needs.
//! #import shadow_layers

fn relievo_shadow_hard(
    field: RelievoHeightField, light: RelievoRay, depth: f32, reach: f32, options: RelievoMarchOptions,
) -> RelievoShadowRecord {
    return relievo_shadow_by_layers(field, light, depth, reach, options, true);
}
