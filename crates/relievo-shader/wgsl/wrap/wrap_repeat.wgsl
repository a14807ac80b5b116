//! Beyond its border a map tiles.
//!
//! Gives relievo_wrap_repeat: the texel in 0..n that stands for i, any integer.
//! Gives relievo_wrap_repeat_mirror_sign: which way the axes of the map point at uv, 1 or −1.
//! Gives relievo_wrap_repeat_axis_cell, relievo_wrap_repeat_cells_to_exit, relievo_wrap_repeat_axis_cell_beyond,
//! relievo_wrap_repeat_last_texel: where cells stand in the map, for descent.wgsl.
//! Gives relievo_wrap_repeat_cells_in_reach: how far relaxed cones know what lies ahead, for cone.wgsl.
//! Needs nothing.

fn relievo_wrap_repeat(i: i32, n: i32) -> i32 {
    // Remainders of negative numbers are not the same in every language this is translated to.
    let k = select(i, ~i, i < 0) % n;
    return select(k, n - 1 - k, i < 0);
}

fn relievo_wrap_repeat_mirror_sign(uv: vec2f) -> vec2f {
    return vec2f(1.0);
}

// The cell of the map that stands for cell i, and which way it faces.
fn relievo_wrap_repeat_axis_cell(i: i32, n: i32) -> vec2i {
    return vec2i(relievo_wrap_repeat(i, n), 1);
}

// How many cells a ray that goes `step` (1 or -1, as the map faces) enters from `index` until it is beyond its block.
fn relievo_wrap_repeat_cells_to_exit(index: i32, step: i32, bit_shift: u32, n: i32) -> i32 {
    let block = index >> bit_shift;
    return select(index - (block << bit_shift) + 1, min((block + 1) << bit_shift, n) - index, step > 0);
}

// The place of a cell one beyond an end of the map.
fn relievo_wrap_repeat_axis_cell_beyond(index: i32, mirror_sign: i32, n: i32) -> vec2i {
    return vec2i(select(select(index, n - 1, index < 0), 0, index == n), mirror_sign);
}

// How many cells a ray that goes `step` (1 or -1) enters from cell i until it is where the relaxed cone of that cell tells
// nothing: a tile away.
fn relievo_wrap_repeat_cells_in_reach(i: i32, step: i32, n: i32) -> i32 {
    return n;
}

// The texel on the far side of the last cell.
fn relievo_wrap_repeat_last_texel(n: i32) -> i32 {
    return 0;
}
