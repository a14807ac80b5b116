use std::str::FromStr;

use relievo_scene::SceneTime;

/// The times of an animation: from the first to before the last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TimeRange {
    pub(super) start: SceneTime,
    pub(super) end: SceneTime,
}

impl FromStr for TimeRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = "expected two times in seconds, the first before the last, as in 0..4";
        let time = |text: &str| text.trim().parse().ok().and_then(SceneTime::from_seconds);
        let (start, end) = text.split_once("..").ok_or(expected)?;
        let (start, end) = (time(start).ok_or(expected)?, time(end).ok_or(expected)?);
        if start >= end {
            return Err(format!("{expected}: an animation of length 0 has no frames"));
        }
        Ok(Self { start, end })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_two_times_that_follow_each_other() {
        let at = |seconds| SceneTime::from_seconds(seconds).unwrap();
        assert_eq!("0..4".parse(), Ok(TimeRange { start: at(0.0), end: at(4.0) }));
        assert_eq!("-1.5 .. 2e1".parse(), Ok(TimeRange { start: at(-1.5), end: at(20.0) }));
        for bad in ["", "4", "4..4", "4..1", "0..nan", "0..inf", "a..b", "0..1e9", ".."] {
            assert!(bad.parse::<TimeRange>().is_err(), "{bad}");
        }
        assert!("1..1".parse::<TimeRange>().unwrap_err().contains("length 0"));
    }
}
