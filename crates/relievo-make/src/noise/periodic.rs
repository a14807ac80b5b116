//! Coordinates and cells that repeat.

/// Wraps a coordinate into [0, 1).
#[inline]
pub(crate) fn wrap_unit(u: f32) -> f32 {
    let r = u - u.floor();
    // Tiny negative numbers round up to 1; NaN and infinity end here too.
    if r < 1.0 { r } else { 0.0 }
}

/// Wraps a cell index into `0..cells`. Mostly in range, so the slow division is rare.
#[inline]
pub(crate) fn wrap_cell(i: i32, cells: u32) -> u32 {
    if (i as u32) < cells { i as u32 } else { i.rem_euclid(cells as i32) as u32 }
}

/// Rounds `x` down. Faster than `f32::floor` where the target lacks a rounding instruction.
#[inline]
pub(crate) fn floor_i32(x: f32) -> i32 {
    let i = x as i32;
    i - i32::from(i as f32 > x)
}

/// Returns the cell after `i`, which repeats.
#[inline]
pub(crate) fn next_cell(i: u32, cells: u32) -> u32 {
    if i + 1 == cells { 0 } else { i + 1 }
}
