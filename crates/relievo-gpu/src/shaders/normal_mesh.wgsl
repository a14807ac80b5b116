//! The mesh's own normal.
//!
//! Gives normal_of_mesh.
//! Needs nothing else.
//! #import tangent
//! #import surface

fn normal_of_mesh(at: Tangent, field: Field, uv: vec2f, footprint: Footprint) -> vec3f {
    return at.frame[2];
}
