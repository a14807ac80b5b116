//! Beyond its border a map's outermost texels stretch.
//!
//! Gives wrap_clamp: the texel in 0..n that stands for i, any integer.
//! Needs nothing.

fn wrap_clamp(i: i32, n: i32) -> i32 {
    return clamp(i, 0, n - 1);
}
