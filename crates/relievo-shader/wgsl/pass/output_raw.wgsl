//! Colours go out as shading computed them, for a target of floats that will be averaged.
//!
//! Gives output_raw.
//! Needs nothing.

fn output_raw(color: vec3f) -> vec3f {
    return color;
}
