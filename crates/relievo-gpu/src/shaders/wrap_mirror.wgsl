//! Beyond its border a map tiles, every second time mirrored.
//!
//! Gives wrap_mirror: the texel in 0..n that stands for i, any integer.
//! Gives wrap_mirror_facing: which way the axes of the map point at uv, 1 or −1.
//! Needs nothing.

fn wrap_mirror(i: i32, n: i32) -> i32 {
    let r = i % (2 * n);
    let k = select(r, r + 2 * n, r < 0);
    return select(2 * n - 1 - k, k, k < n);
}

fn wrap_mirror_facing(uv: vec2f) -> vec2f {
    let tile = floor(uv);
    return 1.0 - 2.0 * (tile - 2.0 * floor(tile * 0.5));
}
