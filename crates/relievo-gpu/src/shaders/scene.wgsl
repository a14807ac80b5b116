//! What is the same for a whole picture.
//!
//! Gives view (camera and shading), lights; declares their bindings, group 0.
//! #import light

const MAX_LIGHTS: u32 = 64u;

struct View {
    eye: vec3f,
    near: f32,
    // The camera's axes. Right and up are divided by half the picture's width and height at distance 1.
    right: vec3f,
    light_count: u32,
    up: vec3f,
    ambient: f32,
    forward: vec3f,
    specular: f32,
    // From one pixel to the next, to the right and down, at distance 1.
    pixel_right: vec3f,
    shininess: f32,
    pixel_down: vec3f,
    // Added to the angle that spreads a penumbra's samples: differs from sample to sample.
    turn: f32,
    // How far the picture is moved, in halves of it, so that the sample lies in the pixel's middle.
    shift: vec2f,
}

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var<uniform> lights: array<Light, MAX_LIGHTS>;
