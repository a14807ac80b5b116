//! Keyframes: values of one key over time.

use relievo_toml::{Entry, Location, Node, Value, did_you_mean};

use super::error::SceneError;
use super::overrides::{segments, set_key};
use super::source::Source;
use crate::SceneTime;

/// Values of one numeric key over time.
#[derive(Clone, Debug)]
pub(super) struct Track {
    /// The key `key` of its table.
    pub(super) at: Location,
    pub(super) path: Vec<String>,
    /// At least one, by rising time, all of as many numbers.
    pub(super) keys: Vec<Keyframe>,
    pub(super) interpolation: Interpolation,
    /// True if the last keyframe is followed by the first.
    pub(super) repeats: bool,
    /// True if the values are lists, not numbers.
    pub(super) is_list: bool,
}

#[derive(Clone, Debug)]
pub(super) struct Keyframe {
    pub(super) time: SceneTime,
    pub(super) values: Vec<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Interpolation {
    Linear,
    /// Cubics with a continuous slope that stay between neighbouring values (Steffen, "A simple method for monotonic
    /// interpolation in one dimension", Astronomy & Astrophysics 239, 1990); at rest at the ends of tracks that do not repeat.
    Smooth,
}

/// Keys that count, and keys of the clock itself: they cannot be animated.
const STILL: [&str; 10] = [
    "width",
    "height",
    "samples",
    "grid",
    "refine_steps",
    "height_size",
    "height_period",
    "repeat",
    "loop",
    "make_size",
];

impl Track {
    /// Reads the path of a key as `--set` has it.
    pub(super) fn path(text: &str) -> Result<Vec<String>, String> {
        let path = segments(text).filter(|path| path.len() <= 8 && path.len() >= 2).ok_or_else(|| {
            "must be the path of a key, as in \"camera.position\" or \"lights.0.intensity\"".to_owned()
        })?;
        if let Some(last) = path.iter().rfind(|part| part.parse::<usize>().is_err())
            && (STILL.contains(&last.as_str()) || path[0] == "time" || path[0] == "animate")
        {
            return Err(format!("cannot be \"{text}\": {last} does not change in the course of a scene"));
        }
        Ok(path)
    }

    /// Sets the key in the tree to its value at a time. What is above the key must be there.
    pub(super) fn apply(&self, root: &mut Vec<Entry>, time: SceneTime, source: &Source) -> Result<(), SceneError> {
        self.check_path(root).map_err(|message| source.error(self.at, message))?;
        let number = |value: f64| Node { at: self.at, value: Value::Float(value) };
        let values = self.values(time);
        let new = match values.as_slice() {
            [value] if !self.is_list => number(*value),
            values => Node { at: self.at, value: Value::Array(values.iter().map(|&value| number(value)).collect()) },
        };
        set_key(root, &self.path, 0, new).map_err(|message| source.error(self.at, message))
    }

    /// True if it sets the key at this path, one inside it, or one that it is inside of.
    pub(super) fn shares_key(&self, path: &[String]) -> bool {
        self.path.iter().zip(path).all(|(a, b)| a == b)
    }

    /// True if the value after a loop of this length is that of its beginning. Angles may have gone round.
    pub(super) fn closes_after(&self, length: SceneTime) -> bool {
        let is_angle = self.path.iter().any(|key| ["rotate", "uv_rotate"].contains(&key.as_str()));
        let ends = self.values(SceneTime::default()).into_iter().zip(self.values(length));
        ends.into_iter().all(|(a, b)| a == b || (is_angle && (b - a) % 360.0 == 0.0))
    }

    /// Refuses a path through tables that are not there, and one that ends at what is no number.
    fn check_path(&self, root: &[Entry]) -> Result<(), String> {
        let name = self.path.join(".");
        let mut below: Option<&Node> = None;
        for (depth, key) in self.path.iter().enumerate() {
            let walked = || self.path[..depth].join(".");
            let entries = match below.map(|node| &node.value) {
                None => root,
                Some(Value::Table(entries)) => entries,
                Some(Value::Array(items)) => {
                    below = key.parse::<usize>().ok().and_then(|index| items.get(index));
                    if below.is_none() {
                        let count = items.len();
                        return Err(format!(
                            "key = \"{name}\": \"{}\" is a list of {count} and has no \"{key}\"",
                            walked()
                        ));
                    }
                    continue;
                }
                Some(value) => {
                    return Err(format!(
                        "key = \"{name}\": \"{}\" is {}, with nothing inside",
                        walked(),
                        value.describe()
                    ));
                }
            };
            let Some(entry) = entries.iter().find(|entry| entry.key == *key) else {
                // Keys and tables with defaults need not be written.
                let is_defaulted = match depth {
                    0 => ["image", "camera", "shading"].contains(&key.as_str()),
                    _ => depth + 1 == self.path.len() || (depth == 2 && key == "relief"),
                };
                if is_defaulted {
                    return Ok(());
                }
                let near = did_you_mean(key, entries.iter().map(|entry| entry.key.as_str()));
                return Err(format!("key = \"{name}\": the scene has no \"{}\"{near}", self.path[..=depth].join(".")));
            };
            below = Some(&entry.node);
        }
        let is_numeric = |node: &Node| node.value.number().is_some();
        match below.map(|node| (node, &node.value)) {
            Some((_, Value::Array(items))) if items.iter().all(is_numeric) => Ok(()),
            Some((node, value)) if !is_numeric(node) => {
                Err(format!("key = \"{name}\" is {}: only numbers can be animated", value.describe()))
            }
            _ => Ok(()),
        }
    }

    /// Returns the values at a time.
    fn values(&self, time: SceneTime) -> Vec<f64> {
        let (first, last) = (&self.keys[0], &self.keys[self.keys.len() - 1]);
        let length = last.time.since(first.time);
        let time = if self.repeats { time.since(first.time).wrapped(length) } else { time.since(first.time) };
        let after = self.keys.partition_point(|key| key.time.since(first.time) <= time);
        let Some(from) = after.checked_sub(1) else { return first.values.clone() };
        let (Some(b), a) = (self.keys.get(after), &self.keys[from]) else { return last.values.clone() };
        let step = b.time.since(a.time).seconds();
        let t = time.since(a.time.since(first.time)).seconds() / step;
        let value = |k: usize| {
            let (from_value, to_value) = (a.values[k], b.values[k]);
            match self.interpolation {
                Interpolation::Linear => from_value + (to_value - from_value) * t,
                Interpolation::Smooth => {
                    let [p, q] = [self.slope(from, k) * step, self.slope(after, k) * step];
                    let change = to_value - from_value;
                    from_value + t * (p + t * (3.0 * change - 2.0 * p - q + t * (p + q - 2.0 * change)))
                }
            }
        };
        (0..a.values.len()).map(value).collect()
    }

    /// Returns the slope at a keyframe, per second (Steffen, equations 6 and 11).
    fn slope(&self, at: usize, k: usize) -> f64 {
        let last = self.keys.len() - 1;
        let secant = |from: usize| {
            let (a, b) = (&self.keys[from], &self.keys[from + 1]);
            let step = b.time.since(a.time).seconds();
            (step, (b.values[k] - a.values[k]) / step)
        };
        // Of a track that repeats, the last keyframe is the first one.
        let (before, after) = match at {
            0 if self.repeats => (secant(last - 1), secant(0)),
            at if at == last && self.repeats => (secant(last - 1), secant(0)),
            0 => return 0.0,
            at if at == last => return 0.0,
            at => (secant(at - 1), secant(at)),
        };
        let ((h, s), (next_h, next_s)) = (before, after);
        if s * next_s <= 0.0 {
            return 0.0;
        }
        let parabola = (s * next_h + next_s * h) / (h + next_h);
        2.0 * s.signum() * s.abs().min(next_s.abs()).min(0.5 * parabola.abs())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn track(keys: &[(f64, f64)], interpolation: Interpolation, repeats: bool) -> Track {
        let key = |&(time, value): &(f64, f64)| Keyframe { time: at(time), values: vec![value] };
        let path = vec!["camera".to_owned(), "near".to_owned()];
        let keys = keys.iter().map(key).collect();
        Track { at: Location::Line(1), path, keys, interpolation, repeats, is_list: false }
    }

    fn at(seconds: f64) -> SceneTime {
        SceneTime::from_seconds(seconds).unwrap()
    }

    #[test]
    fn linear_values_lie_on_the_line_and_stay_beyond_the_ends() {
        let track = track(&[(1.0, 2.0), (3.0, 6.0), (4.0, 0.0)], Interpolation::Linear, false);
        for (time, expected) in [(-5.0, 2.0), (1.0, 2.0), (2.0, 4.0), (3.0, 6.0), (3.5, 3.0), (4.0, 0.0), (9.0, 0.0)] {
            assert_eq!(track.values(at(time)), [expected], "{time}");
        }
    }

    #[test]
    fn a_track_that_repeats_goes_on_from_its_last_keyframe_as_from_its_first() {
        for interpolation in [Interpolation::Linear, Interpolation::Smooth] {
            let track = track(&[(1.0, 2.0), (2.0, 7.0), (4.0, 2.0)], interpolation, true);
            for k in 0..30 {
                let time = f64::from(k) * 0.1;
                assert_eq!(track.values(at(1.0 + time)), track.values(at(4.0 + time)), "{time}");
                assert_eq!(track.values(at(1.0 + time)), track.values(at(time - 29.0)), "{time}");
            }
        }
    }

    #[test]
    fn smooth_values_pass_through_the_keyframes_without_overshoot_and_with_one_slope() {
        for repeats in [false, true] {
            let keys = [(0.0, 0.0), (1.0, 4.0), (1.5, 4.5), (3.0, -2.0), (4.0, 0.0)];
            let track = track(&keys, Interpolation::Smooth, repeats);
            let value = |time: f64| track.values(at(time))[0];
            for pair in keys.windows(2) {
                assert_eq!(value(pair[0].0), pair[0].1);
                let (low, high) = (pair[0].1.min(pair[1].1), pair[0].1.max(pair[1].1));
                for i in 0..=100 {
                    let x = value(pair[0].0 + (pair[1].0 - pair[0].0) * f64::from(i) / 101.0);
                    assert!(x >= low - 1e-12 && x <= high + 1e-12, "{x} in {low}..{high}");
                }
            }
            let e = 1e-4;
            for time in [1.0, 1.5, 3.0].into_iter().chain(repeats.then_some(4.0)) {
                let (left, right) = ((value(time) - value(time - e)) / e, (value(time + e) - value(time)) / e);
                assert!((left - right).abs() < 0.02, "{time}: {left} {right}");
            }
            assert_eq!(value(1e5 + 0.5) == 0.0, !repeats);
        }
    }
}
