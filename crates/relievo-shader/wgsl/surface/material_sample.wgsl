//! What shading needs to know of a point of a surface.
//!
//! Gives RelievoMaterialSample.
//! Needs nothing.

struct RelievoMaterialSample {
    base_color: vec3f,
    roughness: f32,
    metallic: f32,
    ao: f32,
}
