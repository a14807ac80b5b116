//! Beyond its border a map tiles, every second time mirrored.
//!
//! Gives relievo_wrap_mirror: the texel in 0..n that stands for i, any integer.
//! Gives relievo_wrap_mirror_mirror_sign: which way the axes of the map point at uv, 1 or −1.
//! Gives relievo_wrap_mirror_axis_cell, relievo_wrap_mirror_cells_to_exit, relievo_wrap_mirror_axis_cell_beyond,
//! relievo_wrap_mirror_last_texel: where cells stand in the map, for descent.wgsl.
//! Gives relievo_wrap_mirror_cells_in_reach: how far relaxed cones know what lies ahead, for cone.wgsl.
//! Needs nothing.

fn relievo_wrap_mirror(i: i32, n: i32) -> i32 {
    // Remainders of negative numbers are not the same in every language this is translated to. Mirrored at 0, i is -1 - i.
    let k = select(i, ~i, i < 0) % (2 * n);
    return select(2 * n - 1 - k, k, k < n);
}

fn relievo_wrap_mirror_mirror_sign(uv: vec2f) -> vec2f {
    let tile = floor(uv);
    return 1.0 - 2.0 * (tile - 2.0 * floor(tile * 0.5));
}

// The cell of the map that stands for cell i, and which way it faces. -1 is the cell between the first texel and its image.
fn relievo_wrap_mirror_axis_cell(i: i32, n: i32) -> vec2i {
    let j = i + 1;
    // Counted from -1 on, with no remainder of a negative number.
    let r = select(j, ~j, j < 0) % (2 * n);
    let k = select(r, 2 * n - 1 - r, j < 0);
    return select(vec2i(2 * n - 1 - k, -1), vec2i(k - 1, 1), k <= n);
}

// How many cells a ray that goes `step` (1 or -1, as the map faces) enters from `index` until it is beyond its block.
fn relievo_wrap_mirror_cells_to_exit(index: i32, step: i32, bit_shift: u32, n: i32) -> i32 {
    if bit_shift == 0u {
        return 1;
    }
    let block = max(index, 0) >> bit_shift;
    // The first block has the cell before it.
    let first = select(block << bit_shift, -1, block == 0);
    return select(index - first + 1, min((block + 1) << bit_shift, n) - index, step > 0);
}

// The place of a cell one beyond an end of the map.
fn relievo_wrap_mirror_axis_cell_beyond(index: i32, mirror_sign: i32, n: i32) -> vec2i {
    if index == n {
        return vec2i(n - 2, -mirror_sign);
    }
    return select(vec2i(index, mirror_sign), vec2i(0, -mirror_sign), index == -2);
}

// How many cells a ray that goes `step` (1 or -1) enters from cell i until it is where the relaxed cone of that cell tells
// nothing, beyond the next border. The cell between the last texel and its image is alone.
fn relievo_wrap_mirror_cells_in_reach(i: i32, step: i32, n: i32) -> i32 {
    let cell = relievo_wrap_mirror_axis_cell(i, n);
    if cell[0] < 0 || cell[0] == n - 1 {
        return 1;
    }
    return select(cell[0] + 1, n - 1 - cell[0], step * cell[1] > 0);
}

// The texel on the far side of the last cell.
fn relievo_wrap_mirror_last_texel(n: i32) -> i32 {
    return n - 1;
}
