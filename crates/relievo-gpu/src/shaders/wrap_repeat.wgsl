//! Beyond its border a map tiles.
//!
//! Gives wrap_repeat: the texel in 0..n that stands for i, any integer.
//! Needs nothing.

fn wrap_repeat(i: i32, n: i32) -> i32 {
    let k = i % n;
    return select(k, k + n, k < 0);
}
