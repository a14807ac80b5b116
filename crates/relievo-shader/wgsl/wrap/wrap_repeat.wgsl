//! Beyond its border a map tiles.
//!
//! Gives wrap_repeat: the texel in 0..n that stands for i, any integer.
//! Gives wrap_repeat_facing: which way the axes of the map point at uv, 1 or −1.
//! Gives wrap_repeat_place, wrap_repeat_leave, wrap_repeat_beyond, wrap_repeat_last: where cells stand in the map, for descent.wgsl.
//! Gives wrap_repeat_reach: how far relaxed cones know what lies ahead, for cone.wgsl.
//! Needs nothing.

fn wrap_repeat(i: i32, n: i32) -> i32 {
    // Remainders of negative numbers are not the same in every language this is translated to.
    let k = select(i, ~i, i < 0) % n;
    return select(k, n - 1 - k, i < 0);
}

fn wrap_repeat_facing(uv: vec2f) -> vec2f {
    return vec2f(1.0);
}

// The cell of the map that stands for cell i, and which way it faces.
fn wrap_repeat_place(i: i32, n: i32) -> vec2i {
    return vec2i(wrap_repeat(i, n), 1);
}

// How many cells a ray that goes `way` (1 or -1, as the map faces) enters from `index` until it is beyond its block.
fn wrap_repeat_leave(index: i32, way: i32, shift: u32, n: i32) -> i32 {
    let block = index >> shift;
    return select(index - (block << shift) + 1, min((block + 1) << shift, n) - index, way > 0);
}

// The place of a cell one beyond an end of the map.
fn wrap_repeat_beyond(index: i32, facing: i32, n: i32) -> vec2i {
    return vec2i(select(select(index, n - 1, index < 0), 0, index == n), facing);
}

// How many cells a ray that goes `way` (1 or -1) enters from cell i until it is where the relaxed cone of that cell tells
// nothing: a tile away.
fn wrap_repeat_reach(i: i32, way: i32, n: i32) -> i32 {
    return n;
}

// The texel on the far side of the last cell.
fn wrap_repeat_last(n: i32) -> i32 {
    return 0;
}
