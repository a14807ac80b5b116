//! Colours go out as they are: display numbers, or light for a target that encodes by itself.
//!
//! Gives relievo_output_as_is.
//! Needs nothing.

fn relievo_output_as_is(color: vec3f) -> vec3f {
    return clamp(color, vec3f(0.0), vec3f(1.0));
}
