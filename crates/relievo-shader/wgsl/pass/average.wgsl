//! A picture drawn several times: one sample's share, and the mean as colours go out.
//!
//! Gives the entry points `relievo_full_screen` (vertex), `relievo_add_share` and `relievo_resolve` (fragment);
//! declares its bindings.
//! #import chosen_output

@group(0) @binding(0) var relievo_picture: texture_2d<f32>;
// What a sample's colour is multiplied with.
@group(0) @binding(1) var<uniform> relievo_share: vec4f;

// One triangle that covers everything.
@vertex
fn relievo_full_screen(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u));
    return vec4f(corner * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn relievo_add_share(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return textureLoad(relievo_picture, vec2i(at.xy), 0) * relievo_share;
}

@fragment
fn relievo_resolve(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return vec4f(relievo_output_color(textureLoad(relievo_picture, vec2i(at.xy), 0).rgb), 1.0);
}
