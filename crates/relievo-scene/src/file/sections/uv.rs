//! The texture coordinates of `[materials.NAME]`.

use glam::{DVec2, Vec2};
use relievo_map::Wrap;

use crate::file::error::SceneError;
use crate::file::keys::MAX_NUMBER;
use crate::file::table::Table;
use crate::{SceneTime, UvTransform};

/// Reads `uv_offset`, `uv_rotate` and `uv_scale`.
pub(super) fn transform(table: &Table<'_>) -> Result<UvTransform, SceneError> {
    let sound_scale = |x: f32| (1e-9..=MAX_NUMBER).contains(&x.abs());
    let expected = "a number or 2 numbers, each of magnitude 1e-9 to 1e9";
    Ok(UvTransform {
        offset: table.numbers("uv_offset", "2 finite numbers", |_| true)?.map_or(Vec2::ZERO, Vec2::from_array),
        rotate: table.number("uv_rotate", "a number of degrees", |_| true)?.unwrap_or(0.0),
        scale: table.number_or_numbers("uv_scale", expected, sound_scale)?.map_or(Vec2::ONE, Vec2::from_array),
    })
}

/// Returns how far coordinates that move at this velocity, in repeats per second, have come. Whole repeats of maps that repeat
/// are left out: they cost precision.
pub(super) fn moved(velocity: [f64; 2], time: SceneTime, wrap: Wrap) -> Vec2 {
    let moved = DVec2::from(velocity) * time.seconds();
    if wrap == Wrap::Repeat { (moved - moved.floor()).as_vec2() } else { moved.as_vec2() }
}

/// Reads `uv_rect`.
pub(super) fn rect(table: &Table<'_>) -> Result<Option<[f32; 4]>, SceneError> {
    let expected = "4 numbers u0, v0, u1, v1 with u0 below u1 and v0 below v1";
    let rect = table.numbers::<4>("uv_rect", expected, |_| true)?;
    match rect {
        Some([u0, v0, u1, v1]) if !(u0 < u1 && v0 < v1) => {
            let found = format!("[{u0}, {v0}, {u1}, {v1}]");
            let message = format!("uv_rect in {} must be {expected}, found {found}", table.label());
            Err(table.error("uv_rect", message))
        }
        rect => Ok(rect),
    }
}
