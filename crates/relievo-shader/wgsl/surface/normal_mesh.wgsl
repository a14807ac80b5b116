//! The mesh's own normal.
//!
//! Gives relievo_normal_of_mesh.
//! Needs nothing else.
//! #import tangent
//! #import surface
//! #import mean_normal

fn relievo_normal_of_mesh(
    at: RelievoTangentFrame, field: RelievoHeightField, uv: vec2f, footprint: RelievoFootprint,
) -> RelievoMeanNormal {
    return RelievoMeanNormal(at.frame[2], 1.0);
}
