//! `[[animate]]`.

use relievo_toml::Value;

use crate::SceneTime;
use crate::file::error::SceneError;
use crate::file::keys::{self, MAX_NUMBER};
use crate::file::table::Table;
use crate::file::track::{Interpolation, Keyframe, Track};

/// The most keyframes of a scene: each is checked when the scene is loaded.
const MAX_KEYFRAMES: usize = 10_000;

/// The most numbers of a value: no key has more.
const MAX_VALUES: usize = 4;

/// Reads all tracks.
pub(in crate::file) fn tracks(root: &Table<'_>) -> Result<Vec<Track>, SceneError> {
    let mut tracks: Vec<Track> = Vec::new();
    for table in root.tables("animate", keys::ANIMATE)? {
        let track = track(&table)?;
        if let Some(other) = tracks.iter().find(|other| other.shares_key(&track.path)) {
            let (path, other) = (track.path.join("."), other.path.join("."));
            return Err(table.error(
                "key",
                format!("key = \"{path}\" in [[animate]]: another [[animate]] sets \"{other}\"; keep one"),
            ));
        }
        tracks.push(track);
        let count: usize = tracks.iter().map(|track| track.keys.len()).sum();
        if count > MAX_KEYFRAMES {
            return Err(table
                .error("keys", format!("the scene has more than {MAX_KEYFRAMES} keyframes, the most there may be")));
        }
    }
    Ok(tracks)
}

fn track(table: &Table<'_>) -> Result<Track, SceneError> {
    const EXPECTED: &str = "the path of a key, as in \"camera.position\" or \"lights.0.intensity\"";
    let Some(path) = table.text("key", EXPECTED)? else {
        return Err(table.error("key", format!("[[animate]] needs a key: {EXPECTED}")));
    };
    let path = Track::path(path).map_err(|message| table.error("key", format!("key in [[animate]] {message}")))?;
    let interpolations = [("linear", Interpolation::Linear), ("smooth", Interpolation::Smooth)];
    let interpolation = table.one_of("interpolation", &interpolations)?.unwrap_or(Interpolation::Linear);
    let repeats = table.boolean("loop")?.unwrap_or(false);
    let (keys, is_list) = keyframes(table)?;
    if repeats && keys.len() < 2 {
        return Err(table.error(
            "loop",
            "a loop needs two keyframes or more in [[animate]]: with one its length is 0; add one, or leave loop out",
        ));
    }
    Ok(Track { at: table.at("key"), path, keys, interpolation, repeats, is_list })
}

/// Reads `keys`; true if the values are lists.
fn keyframes(table: &Table<'_>) -> Result<(Vec<Keyframe>, bool), SceneError> {
    let mut keys: Vec<Keyframe> = Vec::new();
    let mut are_lists = false;
    for key in table.tables("keys", keys::KEYFRAME)? {
        let (values, is_list) = values(&key)?;
        let time = time(&key)?;
        if let Some(last) = keys.last() {
            if time <= last.time {
                let message = format!(
                    "the keyframes of [[animate]] must follow each other in time, found {time} after {}",
                    last.time
                );
                return Err(key.error("time", message));
            }
            if (values.len(), is_list) != (last.values.len(), are_lists) {
                return Err(key.error("value", "all values of one [[animate]] must have as many numbers"));
            }
        }
        are_lists = is_list;
        keys.push(Keyframe { time, values });
    }
    if keys.is_empty() {
        let message = "[[animate]] needs keys: a list of keyframes, as in keys = [{ time = 0, value = 1 }, { time = 2, value = 3 }]";
        return Err(table.error("keys", message));
    }
    Ok((keys, are_lists))
}

fn time(key: &Table<'_>) -> Result<SceneTime, SceneError> {
    let expected = "a number of seconds, of magnitude at most 1e6";
    let found = key.number("time", expected, |x| f64::from(x.abs()) <= SceneTime::MAX_SECONDS)?;
    let exact = found.and_then(|_| key.get("time")?.value.number()).and_then(SceneTime::from_seconds);
    exact.ok_or_else(|| key.error("time", format!("a keyframe needs a time: {expected}")))
}

/// Reads `value`; true if it is a list.
fn values(key: &Table<'_>) -> Result<(Vec<f64>, bool), SceneError> {
    let expected =
        format!("a finite number of magnitude at most {MAX_NUMBER:e}, or a list of up to {MAX_VALUES} of them");
    let Some(node) = key.get("value") else {
        return Err(key.error("value", format!("a keyframe needs a value: {expected}")));
    };
    let (items, is_list) = match &node.value {
        Value::Array(items) => (items.as_slice(), true),
        _ => (std::slice::from_ref(node), false),
    };
    let sound = |x: &f64| x.abs() <= f64::from(MAX_NUMBER);
    let values: Vec<f64> = items.iter().filter_map(|item| item.value.number()).filter(sound).collect();
    if values.len() != items.len() || values.is_empty() || values.len() > MAX_VALUES {
        let wrong = items.iter().find(|item| !item.value.number().is_some_and(|x| sound(&x))).unwrap_or(node);
        let message = format!("value in {} must be {expected}, found {}", keys::KEYFRAME, wrong.value.describe());
        return Err(key.error("value", message));
    }
    Ok((values, is_list))
}
