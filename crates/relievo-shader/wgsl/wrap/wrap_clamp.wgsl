//! Beyond its border a map's outermost texels stretch.
//!
//! Gives relievo_wrap_clamp: the texel in 0..n that stands for i, any integer.
//! Gives relievo_wrap_clamp_mirror_sign: which way the axes of the map point at uv, 1 or −1.
//! Gives relievo_wrap_clamp_axis_cell, relievo_wrap_clamp_cells_to_exit, relievo_wrap_clamp_axis_cell_beyond,
//! relievo_wrap_clamp_last_texel: where cells stand in the map, for descent.wgsl.
//! Gives relievo_wrap_clamp_cells_in_reach: how far relaxed cones know what lies ahead, for cone.wgsl.
//! Needs nothing.

fn relievo_wrap_clamp(i: i32, n: i32) -> i32 {
    return clamp(i, 0, n - 1);
}

fn relievo_wrap_clamp_mirror_sign(uv: vec2f) -> vec2f {
    return vec2f(1.0);
}

// The cell of the map that stands for cell i, and which way it faces. All beyond the first and the last are one each.
fn relievo_wrap_clamp_axis_cell(i: i32, n: i32) -> vec2i {
    return vec2i(i, 1);
}

// How many cells a ray that goes `step` enters from `index` until it is beyond its block; 2^30: it never is.
fn relievo_wrap_clamp_cells_to_exit(index: i32, step: i32, bit_shift: u32, n: i32) -> i32 {
    let block = clamp(index, 0, n - 1) >> bit_shift;
    if step > 0 {
        if bit_shift == 0u && index < 0 {
            return -index;
        }
        let beyond = min((block + 1) << bit_shift, n);
        return select(beyond - index, 1 << 30u, beyond == n);
    }
    let first = block << bit_shift;
    let one = bit_shift == 0u && index >= 0;
    return select(1 << 30u, index - first + 1, first > 0 || one);
}

// The place of a cell one beyond an end of the map.
fn relievo_wrap_clamp_axis_cell_beyond(index: i32, mirror_sign: i32, n: i32) -> vec2i {
    return vec2i(index, mirror_sign);
}

// How many cells a ray that goes `step` (1 or -1) enters from cell i until it is where the relaxed cone of that cell tells
// nothing, beyond the next border; 2^30: it never is.
fn relievo_wrap_clamp_cells_in_reach(i: i32, step: i32, n: i32) -> i32 {
    let before = select(-i, 1 << 30u, step < 0);
    let inside = select(n - 1 - i, i + 1, step < 0);
    let behind = select(1 << 30u, i - n + 2, step < 0);
    return select(select(behind, inside, i < n - 1), before, i < 0);
}

// The texel on the far side of the last cell.
fn relievo_wrap_clamp_last_texel(n: i32) -> i32 {
    return n - 1;
}
