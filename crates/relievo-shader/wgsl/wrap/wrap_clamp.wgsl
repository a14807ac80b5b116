//! Beyond its border a map's outermost texels stretch.
//!
//! Gives wrap_clamp: the texel in 0..n that stands for i, any integer.
//! Gives wrap_clamp_facing: which way the axes of the map point at uv, 1 or −1.
//! Gives wrap_clamp_place, wrap_clamp_leave, wrap_clamp_beyond, wrap_clamp_last: where cells stand in the map, for
//! descent.wgsl.
//! Gives wrap_clamp_reach: how far relaxed cones know what lies ahead, for cone.wgsl.
//! Needs nothing.

fn wrap_clamp(i: i32, n: i32) -> i32 {
    return clamp(i, 0, n - 1);
}

fn wrap_clamp_facing(uv: vec2f) -> vec2f {
    return vec2f(1.0);
}

// The cell of the map that stands for cell i, and which way it faces. All beyond the first and the last are one each.
fn wrap_clamp_place(i: i32, n: i32) -> vec2i {
    return vec2i(i, 1);
}

// How many cells a ray that goes `way` enters from `index` until it is beyond its block; 2^30: it never is.
fn wrap_clamp_leave(index: i32, way: i32, shift: u32, n: i32) -> i32 {
    let block = clamp(index, 0, n - 1) >> shift;
    if way > 0 {
        if shift == 0u && index < 0 {
            return -index;
        }
        let beyond = min((block + 1) << shift, n);
        return select(beyond - index, 1 << 30u, beyond == n);
    }
    let first = block << shift;
    let one = shift == 0u && index >= 0;
    return select(1 << 30u, index - first + 1, first > 0 || one);
}

// The place of a cell one beyond an end of the map.
fn wrap_clamp_beyond(index: i32, facing: i32, n: i32) -> vec2i {
    return vec2i(index, facing);
}

// How many cells a ray that goes `way` (1 or -1) enters from cell i until it is where the relaxed cone of that cell tells
// nothing, beyond the next border; 2^30: it never is.
fn wrap_clamp_reach(i: i32, way: i32, n: i32) -> i32 {
    let before = select(-i, 1 << 30u, way < 0);
    let inside = select(n - 1 - i, i + 1, way < 0);
    let behind = select(1 << 30u, i - n + 2, way < 0);
    return select(select(behind, inside, i < n - 1), before, i < 0);
}

// The texel on the far side of the last cell.
fn wrap_clamp_last(n: i32) -> i32 {
    return n - 1;
}
