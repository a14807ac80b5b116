//! Beyond its border a map tiles, every second time mirrored.
//!
//! Gives wrap_mirror: the texel in 0..n that stands for i, any integer.
//! Gives wrap_mirror_facing: which way the axes of the map point at uv, 1 or −1.
//! Needs nothing.

fn wrap_mirror(i: i32, n: i32) -> i32 {
    // Remainders of negative numbers are not the same in every language this is translated to. Mirrored at 0, i is -1 - i.
    let k = select(i, ~i, i < 0) % (2 * n);
    return select(2 * n - 1 - k, k, k < n);
}

fn wrap_mirror_facing(uv: vec2f) -> vec2f {
    let tile = floor(uv);
    return 1.0 - 2.0 * (tile - 2.0 * floor(tile * 0.5));
}
