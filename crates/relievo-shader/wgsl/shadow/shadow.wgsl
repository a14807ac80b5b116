//! The one self-shadow: how much of a light reaches a point of the relief.
//!
//! Gives relievo_shadow, relievo_shadow_up_to.
//! Needs what height.wgsl needs.
//! #import record
//! #import height
//! #import chosen_shadow

// Marches from `light.uv`, at `depth`, towards a light. `light` is built from L as a view ray is from V: it comes from the
// light. Of `options` the layer counts, `offset_limiting` and the bounds are used. Ends for every input.
fn relievo_shadow(
    field: RelievoHeightField, light: RelievoRay, depth: f32, options: RelievoMarchOptions,
) -> RelievoShadowRecord {
    return relievo_shadow_up_to(field, light, depth, RELIEVO_FAR_LIGHT, options);
}

// The same, but only as far as the light is, at the distance `reach` in full depths: nothing beyond hides a lamp that hangs
// among the relief, which may also lie lower than the point. At most RELIEVO_FAR_LIGHT.
fn relievo_shadow_up_to(
    field: RelievoHeightField, light: RelievoRay, depth: f32, reach: f32, options: RelievoMarchOptions,
) -> RelievoShadowRecord {
    return relievo_shadow_by_kind(field, light, depth, reach, options);
}

