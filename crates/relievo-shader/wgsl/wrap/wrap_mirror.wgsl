//! Beyond its border a map tiles, every second time mirrored.
//!
//! Gives wrap_mirror: the texel in 0..n that stands for i, any integer.
//! Gives wrap_mirror_facing: which way the axes of the map point at uv, 1 or −1.
//! Gives wrap_mirror_place, wrap_mirror_leave, wrap_mirror_beyond, wrap_mirror_last: where cells stand in the map, for
//! descent.wgsl.
//! Gives wrap_mirror_reach: how far relaxed cones know what lies ahead, for cone.wgsl.
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

// The cell of the map that stands for cell i, and which way it faces. -1 is the cell between the first texel and its image.
fn wrap_mirror_place(i: i32, n: i32) -> vec2i {
    let j = i + 1;
    // Counted from -1 on, with no remainder of a negative number.
    let r = select(j, ~j, j < 0) % (2 * n);
    let k = select(r, 2 * n - 1 - r, j < 0);
    return select(vec2i(2 * n - 1 - k, -1), vec2i(k - 1, 1), k <= n);
}

// How many cells a ray that goes `way` (1 or -1, as the map faces) enters from `index` until it is beyond its block.
fn wrap_mirror_leave(index: i32, way: i32, shift: u32, n: i32) -> i32 {
    if shift == 0u {
        return 1;
    }
    let block = max(index, 0) >> shift;
    // The first block has the cell before it.
    let first = select(block << shift, -1, block == 0);
    return select(index - first + 1, min((block + 1) << shift, n) - index, way > 0);
}

// The place of a cell one beyond an end of the map.
fn wrap_mirror_beyond(index: i32, facing: i32, n: i32) -> vec2i {
    if index == n {
        return vec2i(n - 2, -facing);
    }
    return select(vec2i(index, facing), vec2i(0, -facing), index == -2);
}

// How many cells a ray that goes `way` (1 or -1) enters from cell i until it is where the relaxed cone of that cell tells
// nothing, beyond the next border. The cell between the last texel and its image is alone.
fn wrap_mirror_reach(i: i32, way: i32, n: i32) -> i32 {
    let place = wrap_mirror_place(i, n);
    if place[0] < 0 || place[0] == n - 1 {
        return 1;
    }
    return select(place[0] + 1, n - 1 - place[0], way * place[1] > 0);
}

// The texel on the far side of the last cell.
fn wrap_mirror_last(n: i32) -> i32 {
    return n - 1;
}
