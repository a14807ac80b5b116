//! The one self-shadow: how much of a light reaches a point of the relief.
//!
//! Gives relief_shadow.
//! Needs what height.wgsl needs.
//! #import record
//! #import height
//! #import chosen_shadow

// Marches from `light.uv`, at `depth`, towards a light. `light` is built from L as a view ray is from V: it comes from the
// light. Of `how` the layer counts, `offset_limiting` and the bounds are used. Ends for every input.
fn relief_shadow(field: Field, light: Ray, depth: f32, how: March) -> ShadowRecord {
    return kind_shadow(field, light, depth, how);
}

