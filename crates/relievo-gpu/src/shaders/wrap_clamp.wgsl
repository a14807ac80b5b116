//! Beyond its border a map's outermost texels stretch.
//!
//! Gives wrap_clamp: the texel in 0..n that stands for i, any integer.
//! Gives wrap_clamp_facing: which way the axes of the map point at uv, 1 or −1.
//! Needs nothing.

fn wrap_clamp(i: i32, n: i32) -> i32 {
    return clamp(i, 0, n - 1);
}

fn wrap_clamp_facing(uv: vec2f) -> vec2f {
    return vec2f(1.0);
}
