//! Colours go out as shading computed them, for a target of floats that will be averaged.
//!
//! Gives relievo_output_raw.
//! Needs nothing.

fn relievo_output_raw(color: vec3f) -> vec3f {
    return color;
}
