//! A picture drawn several times: one sample's share, and the mean as colours go out.
//!
//! Gives the entry points `whole_picture` (vertex), `add_share` and `resolve` (fragment); declares its bindings.
//! #import chosen_output

@group(0) @binding(0) var picture: texture_2d<f32>;
// What a sample's colour is multiplied with.
@group(0) @binding(1) var<uniform> share: vec4f;

// One triangle that covers everything.
@vertex
fn whole_picture(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u));
    return vec4f(corner * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn add_share(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return textureLoad(picture, vec2i(at.xy), 0) * share;
}

@fragment
fn resolve(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return vec4f(output_color(textureLoad(picture, vec2i(at.xy), 0).rgb), 1.0);
}
