//! Interpolation between heights as software OpenGL does it with 8-bit textures: every result is a multiple of 1/255.
//!
//! Gives relievo_lerp_8_bit.
//! Needs nothing.

fn relievo_lerp_8_bit(a: f32, b: f32, t: f32) -> f32 {
    let x = (a + (b - a) * t) * 255.0;
    // Halves upwards; `round` would send them to the even neighbour.
    let below = floor(x);
    return select(below, below + 1.0, x - below >= 0.5) / 255.0;
}
