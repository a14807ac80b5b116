//! `[time]` and the moment that is asked for.

use crate::SceneTime;
use crate::file::error::SceneError;
use crate::file::keys;
use crate::file::table::Table;

/// The moment of a scene that is read.
#[derive(Clone, Copy, Debug)]
pub(in crate::file) struct Moment {
    /// Within the loop, if there is one.
    pub(in crate::file) time: SceneTime,
    pub(in crate::file) length: Option<SceneTime>,
}

/// Reads the length of the scene's loop.
pub(in crate::file) fn length(root: &Table<'_>) -> Result<Option<SceneTime>, SceneError> {
    let Some(table) = root.table("time", keys::TIME, keys::TIME)? else { return Ok(None) };
    let expected = "a number of seconds, 0.001 to 1e6; a loop of length 0 has no frames";
    let seconds = table.number("loop", expected, |x| (0.001..=1e6).contains(&x))?;
    // As written, not rounded to f32.
    let exact = seconds.and_then(|_| table.get("loop")?.value.number());
    Ok(exact.and_then(SceneTime::from_seconds))
}

impl Moment {
    /// The time, wrapped into the loop of this length.
    pub(in crate::file) fn new(time: SceneTime, length: Option<SceneTime>) -> Self {
        Self { time: length.map_or(time, |length| time.wrapped(length)), length }
    }
}
