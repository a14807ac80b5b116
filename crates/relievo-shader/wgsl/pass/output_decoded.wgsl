//! Display numbers go out as light, for a target that will encode them again.
//!
//! Gives output_decoded.
//! Needs nothing else.
//! #import color

fn output_decoded(color: vec3f) -> vec3f {
    return srgb_to_linear(clamp(color, vec3f(0.0), vec3f(1.0)));
}
