//! Painting of strokes into a height map.

use rayon::prelude::*;
use relievo_map::Grid;

use super::stroke::{Brush, Profile, Stroke};
use crate::curve::smoothstep;
use crate::noise::{hash3, unit_float};

/// A segment of a stroke, in texels, on this repeat.
struct StrokeSegment {
    from: [f32; 2],
    to: [f32; 2],
    /// Half widths at both ends.
    radius: [f32; 2],
    /// Depths at both ends.
    depth: [f32; 2],
    profile: Profile,
    hardness: f32,
}

impl StrokeSegment {
    fn top(&self) -> f32 {
        (self.from[1] - self.radius[0]).min(self.to[1] - self.radius[1])
    }

    fn bottom(&self) -> f32 {
        (self.from[1] + self.radius[0]).max(self.to[1] + self.radius[1])
    }

    fn sides(&self) -> [f32; 2] {
        let left = (self.from[0] - self.radius[0]).min(self.to[0] - self.radius[1]);
        [left, (self.from[0] + self.radius[0]).max(self.to[0] + self.radius[1])]
    }

    /// Returns the height that the segment adds at a point.
    fn at(&self, x: f32, y: f32) -> f32 {
        let (dx, dy) = (self.to[0] - self.from[0], self.to[1] - self.from[1]);
        let (px, py) = (x - self.from[0], y - self.from[1]);
        let length = dx * dx + dy * dy;
        let t = if length > 0.0 { ((px * dx + py * dy) / length).max(0.0).min(1.0) } else { 0.0 };
        let distance = (px - t * dx).hypot(py - t * dy);
        let between = |[a, b]: [f32; 2]| a + (b - a) * t;
        let radius = between(self.radius).max(1e-6);
        if distance >= radius { 0.0 } else { between(self.depth) * self.profile.at(distance / radius, self.hardness) }
    }
}

/// Paints strokes into heights. Where strokes cross, the deepest groove and the highest ridge count; the order does not
/// matter. With `wrap` they continue at the other side.
///
/// Heights may leave [0, 1]; [`HeightMap::new`](relievo_map::HeightMap::new) clamps them. `seed` is for jitter.
#[must_use]
pub fn paint(heights: &Grid<f32>, strokes: &[Stroke], wrap: bool, seed: u32) -> Grid<f32> {
    let (w, h) = (heights.width(), heights.height());
    let length: f32 = strokes.iter().map(Stroke::length).sum();
    // Long strokes are cut more coarsely, so that there are a million segments at most.
    let finest = (1.0f32 / 1024.0).max(length / (1 << 20) as f32);
    let segments: Vec<StrokeSegment> =
        (0u32..).zip(strokes).flat_map(|(k, stroke)| segments(stroke, [w, h], wrap, seed, k, finest)).collect();
    /// Rows that share a list of segments.
    const BAND: usize = 32;
    let width = w as usize;
    let mut out = heights.clone();
    out.texels_mut().par_chunks_mut(BAND * width).enumerate().for_each(|(band, texels)| {
        let first = band * BAND;
        let rows = texels.len() / width;
        let in_band = |p: &&StrokeSegment| p.bottom() > first as f32 && p.top() < (first + rows) as f32;
        let segments: Vec<&StrokeSegment> = segments.iter().filter(in_band).collect();
        // The mean over a texel, or steep edges would be stairs.
        for at in SAMPLES {
            let (mut low, mut high) = (vec![0.0f32; texels.len()], vec![0.0f32; texels.len()]);
            for segment in &segments {
                let [left, right] = segment.sides().map(|x| x.max(0.0).min(w as f32));
                for y in 0..rows {
                    for x in left as usize..(right.ceil() as usize).min(width) {
                        let depth = segment.at(x as f32 + at[0], (first + y) as f32 + at[1]);
                        let i = y * width + x;
                        (low[i], high[i]) = (low[i].min(depth), high[i].max(depth));
                    }
                }
            }
            for ((texel, low), high) in texels.iter_mut().zip(low).zip(high) {
                *texel += (low + high) / SAMPLES.len() as f32;
            }
        }
    });
    out
}

/// Sample positions within a texel: a rotated grid, no two on one row or column.
const SAMPLES: [[f32; 2]; 4] = [[0.125, 0.375], [0.625, 0.125], [0.375, 0.875], [0.875, 0.625]];

/// Cuts a stroke into segments no shorter than `finest`, jittered, tapered and repeated.
fn segments(stroke: &Stroke, [w, h]: [u32; 2], wrap: bool, seed: u32, number: u32, finest: f32) -> Vec<StrokeSegment> {
    let brush = &stroke.brush;
    let line = jittered(&stroke.points, brush, seed ^ number.wrapping_mul(0x9e37_79b9), finest);
    let last = line.len().saturating_sub(1).max(1) as f32;
    // The fraction of its width that a tapered stroke has at each point.
    let strength = |k: usize| {
        let end = (k as f32).min(last - k as f32) / last;
        if brush.taper { smoothstep(0.0, 0.35, end).max(0.08) } else { 1.0 }
    };
    let scale = |[u, v]: [f32; 2]| [u * w as f32, v * h as f32];
    let radius = |k: usize| 0.5 * brush.width * w as f32 * strength(k);
    let depth = |k: usize| brush.depth * strength(k).sqrt();
    let mut segments = Vec::new();
    for k in 0..line.len().max(2) - 1 {
        let k_end = (k + 1).min(line.len() - 1);
        let (a, b) = (line[k], line[k_end]);
        let reach = brush.width;
        let repeats = |axis: usize| {
            let (low, high) = (a[axis].min(b[axis]) - reach, a[axis].max(b[axis]) + reach);
            // The repeats that this segment touches.
            if wrap { (low.floor() as i32, high.floor() as i32) } else { (0, 0) }
        };
        let ((left, right), (top, bottom)) = (repeats(0), repeats(1));
        for j in top..=bottom {
            for i in left..=right {
                let moved = |p: [f32; 2]| scale([p[0] - i as f32, p[1] - j as f32]);
                segments.push(StrokeSegment {
                    from: moved(a),
                    to: moved(b),
                    radius: [radius(k), radius(k_end)],
                    depth: [depth(k), depth(k_end)],
                    profile: brush.profile,
                    hardness: brush.hardness.max(0.0).min(1.0),
                });
            }
        }
    }
    segments
}

/// Resamples the line in short steps, each offset across at random; in steps of a quarter of the map without jitter and
/// taper, so that a segment lies on few repeats.
fn jittered(points: &[[f32; 2]], brush: &Brush, seed: u32, finest: f32) -> Vec<[f32; 2]> {
    if points.len() < 2 {
        return points.to_vec();
    }
    let straight = brush.jitter <= 0.0 && !brush.taper;
    let step = if straight { 0.25 } else { (0.6 * brush.width).max(finest) };
    let mut line = vec![points[0]];
    let mut along = 0.0f32;
    for pair in points.windows(2) {
        let (dx, dy) = (pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]);
        let length = dx.hypot(dy);
        let count = (length / step).ceil().max(1.0).min(1e6);
        for k in 1..=count as u32 {
            let t = k as f32 / count;
            along += length / count / step;
            // Two octaves of value noise along the line.
            let off = brush.jitter * (0.7 * value_noise(0.31 * along, seed) + 0.3 * value_noise(along, seed ^ 0x51));
            let across = if length > 0.0 { [-dy / length, dx / length] } else { [0.0; 2] };
            line.push([pair[0][0] + t * dx + off * across[0], pair[0][1] + t * dy + off * across[1]]);
        }
    }
    line
}

/// Value noise along a line, -1..1.
fn value_noise(x: f32, seed: u32) -> f32 {
    let i = x.floor();
    let value = |k: i32| 2.0 * unit_float(hash3(k as u32, 0, seed)[0]) - 1.0;
    let (a, b) = (value(i as i32), value(i as i32 + 1));
    a + (b - a) * smoothstep(0.0, 1.0, x - i)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(points: &[[f32; 2]], brush: Brush) -> Stroke {
        Stroke { points: points.to_vec(), brush }
    }

    fn plain() -> Grid<f32> {
        Grid::filled(100, 100, 0.5)
    }

    #[test]
    fn a_stroke_is_as_deep_and_as_wide_as_its_brush() {
        let brush = Brush { width: 0.1, depth: -0.4, ..Brush::default() };
        let painted = paint(&plain(), &[line(&[[0.2, 0.5], [0.8, 0.5]], brush)], false, 0);
        assert!((painted.get(50, 50) - 0.1).abs() < 0.01);
        assert!(*painted.get(50, 46) < 0.49 && *painted.get(50, 44) == 0.5 && *painted.get(10, 50) == 0.5);
        let ridge = Brush { depth: 0.2, hardness: 0.9, profile: Profile::Flat, ..brush };
        let painted = paint(&plain(), &[line(&[[0.5, 0.5]], ridge)], false, 0);
        assert!((painted.get(53, 50) - 0.7).abs() < 1e-3, "a dot");
    }

    #[test]
    fn strokes_go_on_at_the_other_side() {
        let brush = Brush { width: 0.06, ..Brush::default() };
        let stroke = [line(&[[0.9, 0.98], [1.1, 1.02]], brush)];
        let painted = paint(&plain(), &stroke, true, 0);
        assert!(*painted.get(5, 1) < 0.4 && *painted.get(95, 99) < 0.4);
        // The same in the middle, rolled by half.
        let middle = paint(&plain(), &[line(&[[0.4, 0.48], [0.6, 0.52]], brush)], true, 0);
        for (x, y) in (0..100).flat_map(|y| (0..100).map(move |x| (x, y))) {
            assert!((painted.get(x, y) - middle.get((x + 50) % 100, (y + 50) % 100)).abs() < 1e-3);
        }
        assert_eq!(*paint(&plain(), &stroke, false, 0).get(5, 1), 0.5);
    }

    #[test]
    fn crossings_are_no_deeper_and_order_and_threads_do_not_matter() {
        let brush = Brush { width: 0.05, depth: -0.3, jitter: 0.01, taper: true, ..Brush::default() };
        let flat = Brush { jitter: 0.0, taper: false, ..brush };
        let cross = [line(&[[0.1, 0.5], [0.9, 0.5]], flat), line(&[[0.5, 0.1], [0.5, 0.9]], flat)];
        let painted = paint(&plain(), &cross, true, 0);
        assert!((painted.get(50, 50) - 0.2).abs() < 0.02);
        let swapped = [cross[1].clone(), cross[0].clone()];
        assert_eq!(painted, paint(&plain(), &swapped, true, 0));
        let wild: Vec<_> = (0..20).map(|k| line(&[[0.1 * k as f32, 0.0], [0.5, 0.07 * k as f32]], brush)).collect();
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| paint(&plain(), &wild, true, 4))
        };
        assert_eq!(on(1), on(7));
        assert_ne!(on(1), paint(&plain(), &wild, true, 5));
    }

    #[test]
    fn twice_the_size_shows_the_same_strokes() {
        let brush = Brush { width: 0.05, jitter: 0.02, taper: true, ..Brush::default() };
        let strokes = [line(&[[0.1, 0.2], [0.7, 0.6], [0.9, 1.2]], brush)];
        let at = |size| paint(&Grid::filled(size, size, 0.5), &strokes, true, 1);
        let (small, large) = (at(128), at(256));
        let off: f32 = (0..128 * 128)
            .map(|k| (k % 128, k / 128))
            .map(|(x, y)| (small.get(x, y) - large.get(2 * x, 2 * y)).abs())
            .sum();
        assert!(off / 16_384.0 < 0.004, "{}", off / 16_384.0);
    }
}
