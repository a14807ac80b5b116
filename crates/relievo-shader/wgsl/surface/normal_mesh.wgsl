//! The mesh's own normal.
//!
//! Gives normal_of_mesh.
//! Needs nothing else.
//! #import tangent
//! #import surface
//! #import mean_normal

fn normal_of_mesh(at: Tangent, field: Field, uv: vec2f, footprint: Footprint) -> MeanNormal {
    return MeanNormal(at.frame[2], 1.0);
}
