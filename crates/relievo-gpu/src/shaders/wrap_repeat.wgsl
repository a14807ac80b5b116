//! Beyond its border a map tiles.
//!
//! Gives wrap_repeat: the texel in 0..n that stands for i, any integer.
//! Gives wrap_repeat_facing: which way the axes of the map point at uv, 1 or −1.
//! Needs nothing.

fn wrap_repeat(i: i32, n: i32) -> i32 {
    // Remainders of negative numbers are not the same in every language this is translated to.
    let k = select(i, ~i, i < 0) % n;
    return select(k, n - 1 - k, i < 0);
}

fn wrap_repeat_facing(uv: vec2f) -> vec2f {
    return vec2f(1.0);
}
