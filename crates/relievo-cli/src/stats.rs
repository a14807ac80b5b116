use relievo_lab::Percentiles;
use relievo_scene::Aovs;
use serde::Serialize;

use crate::backend::Times;

/// The figures of `render --stats`.
#[derive(Serialize)]
pub(crate) struct Stats {
    pub(crate) backend: &'static str,
    pub(crate) adapter: String,
    pub(crate) technique: String,
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) samples: u32,
    pub(crate) frames: usize,
    #[serde(flatten)]
    pub(crate) times: TimeStats,
    /// Pixels in which a surface is seen.
    pub(crate) hit_pixels: usize,
    /// Height look-ups of the view rays, over those pixels.
    pub(crate) fetches: Percentiles,
    /// Loop iterations of the view rays' marches, over those pixels.
    pub(crate) iterations: Percentiles,
    pub(crate) triangles: usize,
    pub(crate) load_ms: f64,
    pub(crate) build_ms: f64,
    pub(crate) peak_bytes: Option<u64>,
}

/// Times of the frames.
#[derive(Serialize)]
pub(crate) struct TimeStats {
    /// By `timer`.
    frame_ms: FrameTimes,
    /// By the program's clock, from recording a frame to its end.
    wall_ms: FrameTimes,
    /// "gpu": the device's own clock, from the first pass to the last; "wall": as `wall_ms`.
    timer: &'static str,
}

impl From<&Times> for TimeStats {
    fn from(times: &Times) -> Self {
        Self {
            frame_ms: FrameTimes::of(times.gpu.as_ref().unwrap_or(&times.wall)),
            wall_ms: FrameTimes::of(&times.wall),
            timer: if times.gpu.is_some() { "gpu" } else { "wall" },
        }
    }
}

/// Milliseconds.
#[derive(Serialize)]
pub(crate) struct FrameTimes {
    min: f64,
    median: f64,
    max: f64,
}

impl FrameTimes {
    pub(crate) fn of(times: &[f64]) -> Self {
        let mut sorted = times.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        let at = |i: usize| sorted.get(i).copied().unwrap_or(0.0);
        let middle = sorted.len() / 2;
        let median = if sorted.len() % 2 == 1 { at(middle) } else { 0.5 * (at(middle.saturating_sub(1)) + at(middle)) };
        Self { min: at(0), median, max: at(sorted.len().saturating_sub(1)) }
    }
}

/// Fetches and iterations over the pixels that show a surface, and how many these are.
pub(crate) fn march_costs(aovs: &Aovs) -> (usize, Percentiles, Percentiles) {
    let over = |values: &[f32]| {
        Percentiles::of(values.iter().zip(aovs.hit.texels()).filter(|&(_, &hit)| hit > 0.0).map(|(&value, _)| value))
    };
    let hit_pixels = aovs.hit.texels().iter().filter(|&&hit| hit > 0.0).count();
    (hit_pixels, over(aovs.fetches.texels()), over(aovs.iterations.texels()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_lies_in_the_middle() {
        let times = |times: &[f64]| FrameTimes::of(times);
        assert_eq!((times(&[3.0, 1.0, 2.0]).median, times(&[3.0, 1.0, 2.0]).max), (2.0, 3.0));
        assert_eq!((times(&[4.0, 1.0]).median, times(&[4.0, 1.0]).min), (2.5, 1.0));
    }
}
