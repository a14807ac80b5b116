//! Coordinates and cells that repeat.

/// A coordinate brought into [0, 1).
#[inline]
pub(crate) fn wrap_unit(u: f32) -> f32 {
    let r = u - u.floor();
    // Tiny negative numbers round up to 1; NaN and infinity end here too.
    if r < 1.0 { r } else { 0.0 }
}

/// The cell `i` of `cells` that repeat, which is mostly in range: divisions are slow.
#[inline]
pub(crate) fn wrap_cell(i: i32, cells: u32) -> u32 {
    if (i as u32) < cells { i as u32 } else { i.rem_euclid(cells as i32) as u32 }
}

/// `x` rounded down: on processors that are not told to be new, faster than the library's.
#[inline]
pub(crate) fn floor_i32(x: f32) -> i32 {
    let i = x as i32;
    i - i32::from(i as f32 > x)
}

#[inline]
pub(crate) fn next_cell(i: u32, cells: u32) -> u32 {
    if i + 1 == cells { 0 } else { i + 1 }
}
