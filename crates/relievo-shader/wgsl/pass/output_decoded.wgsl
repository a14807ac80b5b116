//! Display numbers go out as light, for a target that will encode them again.
//!
//! Gives relievo_output_decoded.
//! Needs nothing else.
//! #import color

fn relievo_output_decoded(color: vec3f) -> vec3f {
    return relievo_srgb_to_linear(clamp(color, vec3f(0.0), vec3f(1.0)));
}
