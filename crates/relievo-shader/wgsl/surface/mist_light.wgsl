//! The light that mist lets through to surfaces, drawn before them.
//!
//! Gives relievo_looked_up_past_mist; declares the binding of group 3.
//! Needs nothing.

@group(3) @binding(0) var relievo_lights_past_mist: texture_2d_array<f32>;

// The share of a light that reaches the surface that is seen through a pixel.
fn relievo_looked_up_past_mist(pixel: vec2f, light: u32) -> f32 {
    return textureLoad(relievo_lights_past_mist, vec2i(pixel), i32(light), 0).r;
}
