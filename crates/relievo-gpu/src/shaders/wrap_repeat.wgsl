//! Beyond its border a map tiles.
//!
//! Gives wrap_repeat: the texel in 0..n that stands for i, any integer.
//! Gives wrap_repeat_facing: which way the axes of the map point at uv, 1 or −1.
//! Needs nothing.

fn wrap_repeat(i: i32, n: i32) -> i32 {
    let k = i % n;
    return select(k, k + n, k < 0);
}

fn wrap_repeat_facing(uv: vec2f) -> vec2f {
    return vec2f(1.0);
}
