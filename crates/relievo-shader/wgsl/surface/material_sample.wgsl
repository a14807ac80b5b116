//! What shading needs to know of a point of a surface.
//!
//! Gives Texels.
//! Needs nothing.

struct Texels {
    base_color: vec3f,
    roughness: f32,
    metallic: f32,
    ao: f32,
}
