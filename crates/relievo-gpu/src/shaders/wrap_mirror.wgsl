//! Beyond its border a map tiles, every second time mirrored.
//!
//! Gives wrap_mirror: the texel in 0..n that stands for i, any integer.
//! Needs nothing.

fn wrap_mirror(i: i32, n: i32) -> i32 {
    // Remainders of negative numbers are not the same in every language this is translated to. Mirrored at 0, i is -1 - i.
    let k = select(i, ~i, i < 0) % (2 * n);
    return select(2 * n - 1 - k, k, k < n);
}
