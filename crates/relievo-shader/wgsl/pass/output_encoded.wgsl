//! Light goes out as display numbers, for a target that takes them as they are.
//!
//! Gives relievo_output_encoded.
//! Needs nothing else.
//! #import color

fn relievo_output_encoded(color: vec3f) -> vec3f {
    return relievo_linear_to_srgb(clamp(color, vec3f(0.0), vec3f(1.0)));
}
