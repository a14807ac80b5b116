use glam::DVec2;
use relievo_map::{Grid, Wrap};
use relievo_march::Bounds;

use super::axis::{Axis, Intervals};

/// Places beyond this are all the same: far outside what f64 tells apart in texels.
const FARTHEST: f64 = (1u64 << 52) as f64;

/// The lowest and highest texels of a map's blocks of 2^k texels, for k from 1 up.
pub(crate) struct HeightRanges {
    levels: Vec<Grid<[f32; 2]>>,
}

impl HeightRanges {
    /// Builds all levels.
    pub(crate) fn build(map: &Grid<f32>) -> Self {
        let mut levels: Vec<Grid<[f32; 2]>> = Vec::new();
        let joined = |[a, b]: [f32; 2], [c, d]: [f32; 2]| [a.min(c), b.max(d)];
        loop {
            let (w, h) = levels.last().map_or((map.width(), map.height()), |last| (last.width(), last.height()));
            if w == 1 && h == 1 {
                return Self { levels };
            }
            let at = |x: u32, y: u32| {
                let (x, y) = (x.min(w - 1), y.min(h - 1));
                levels.last().map_or_else(|| [*map.get(x, y); 2], |last| *last.get(x, y))
            };
            let next = Grid::from_fn(w.div_ceil(2), h.div_ceil(2), |x, y| {
                let row = |y: u32| joined(at(2 * x, y), at(2 * x + 1, y));
                joined(row(2 * y), row(2 * y + 1))
            });
            levels.push(next);
        }
    }

    /// Returns the range over the texels of two intervals of the map.
    fn over(&self, map: &Grid<f32>, [x0, x1]: [usize; 2], [y0, y1]: [usize; 2]) -> [f32; 2] {
        // Blocks as long as the longer interval: at most two of them along each axis.
        let span = (x1 - x0).max(y1 - y0);
        let level = ((usize::BITS - span.leading_zeros()) as usize).min(self.levels.len());
        let mut range = [f32::INFINITY, f32::NEG_INFINITY];
        for y in [y0 >> level, y1 >> level] {
            for x in [x0 >> level, x1 >> level] {
                let [low, high] = match level.checked_sub(1) {
                    Some(level) => *self.levels[level].get(x as u32, y as u32),
                    None => [*map.get(x as u32, y as u32); 2],
                };
                range = [range[0].min(low), range[1].max(high)];
            }
        }
        range
    }
}

/// A height map as one object shows it, in f64: bilinear, or the nearest texel. Places are in texels: a whole number is a
/// texel's centre, where the nearest one counts its lower corner.
#[derive(Clone, Copy)]
pub(super) struct FilteredMap<'a> {
    map: &'a Grid<f32>,
    ranges: &'a HeightRanges,
    axes: [Axis; 2],
    nearest: bool,
}

impl<'a> FilteredMap<'a> {
    pub(super) fn new(
        map: &'a Grid<f32>,
        ranges: &'a HeightRanges,
        nearest: bool,
        (wrap, stretched): (Wrap, Option<Bounds>),
    ) -> Self {
        let size = [map.width(), map.height()];
        let texels = stretched.map(|range| range.texels(size));
        let axis = |k: usize| Axis::new(size[k], wrap, texels.map(|texels| texels[k]));
        Self { map, ranges, axes: [axis(0), axis(1)], nearest }
    }

    /// Returns the place of a uv.
    pub(super) fn place(&self, uv: DVec2) -> DVec2 {
        let size = DVec2::new(f64::from(self.map.width()), f64::from(self.map.height()));
        uv * size - if self.nearest { 0.0 } else { 0.5 }
    }

    /// Returns the height at a place.
    pub(super) fn at(&self, place: DVec2) -> f64 {
        let [(i, a), (j, b)] = [cell(place.x), cell(place.y)];
        if self.nearest {
            let [x, y] = self.axes;
            return f64::from(*self.map.get(x.texel(i) as u32, y.texel(j) as u32));
        }
        self.bilinear(i, j)(a, b)
    }

    /// Returns the heights of a cell as a function of the way from its first texel.
    #[inline]
    fn bilinear(&self, i: i64, j: i64) -> impl Fn(f64, f64) -> f64 + use<> {
        let [x, y] = self.axes;
        let (columns, rows) = ([x.texel(i), x.texel(i + 1)], [y.texel(j), y.texel(j + 1)]);
        let (texels, width) = (self.map.texels(), self.map.width() as usize);
        let [top, bottom] = rows.map(|row| columns.map(|column| f64::from(texels[row * width + column])));
        move |a, b| {
            let along = |[left, right]: [f64; 2]| left + (right - left) * a;
            let (top, bottom) = (along(top), along(bottom));
            top + (bottom - top) * b
        }
    }

    /// Returns bounds of the heights in a rectangle of places: exact where it is smaller than a texel.
    pub(super) fn range(&self, min: DVec2, max: DVec2) -> [f64; 2] {
        let [(i0, a0), (j0, b0)] = [cell(min.x), cell(min.y)];
        let [(i1, a1), (j1, b1)] = [cell(max.x), cell(max.y)];
        if self.nearest {
            return self.range_of_texels([i0, i1], [j0, j1]);
        }
        if i1 == i0 && j1 == j0 {
            let at = self.bilinear(i0, j0);
            let heights = [at(a0, b0), at(a1, b0), at(a0, b1), at(a1, b1)];
            return [
                heights.into_iter().fold(f64::INFINITY, f64::min),
                heights.into_iter().fold(f64::NEG_INFINITY, f64::max),
            ];
        }
        if i1 - i0 <= 1 && j1 - j0 <= 1 {
            return self.range_of_cells(min, max, [i1 > i0, j1 > j0]);
        }
        self.range_of_texels([i0, i1 + 1], [j0, j1 + 1])
    }

    /// Returns the range over the texels from a first to a last column and row.
    fn range_of_texels(&self, [i0, i1]: [i64; 2], [j0, j1]: [i64; 2]) -> [f64; 2] {
        let columns: Intervals = self.axes[0].intervals(i0, i1);
        let rows: Intervals = self.axes[1].intervals(j0, j1);
        let mut range = [f32::INFINITY, f32::NEG_INFINITY];
        for (k, &row) in rows.iter().enumerate() {
            if k == 1 && row == rows[0] {
                continue;
            }
            for (k, &column) in columns.iter().enumerate() {
                if k == 1 && column == columns[0] {
                    continue;
                }
                let [low, high] = self.ranges.over(self.map, column, row);
                range = [range[0].min(low), range[1].max(high)];
            }
        }
        range.map(f64::from)
    }

    /// Returns the range over up to two cells along each axis: a bilinear function is at its extremes in corners.
    fn range_of_cells(&self, min: DVec2, max: DVec2, crosses: [bool; 2]) -> [f64; 2] {
        let stops = |k: usize| {
            let border = if crosses[k] { cell(max[k]).0 as f64 } else { max[k] };
            [min[k], border, max[k]]
        };
        let (xs, ys) = (stops(0), stops(1));
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for (n, &y) in ys.iter().enumerate() {
            if n == 1 && !crosses[1] {
                continue;
            }
            for (m, &x) in xs.iter().enumerate() {
                if m == 1 && !crosses[0] {
                    continue;
                }
                let height = self.at(DVec2::new(x, y));
                range = [range[0].min(height), range[1].max(height)];
            }
        }
        range
    }
}

/// Returns the texel before a place, and the way from it to the next.
#[inline]
fn cell(x: f64) -> (i64, f64) {
    // Also turns NaN into a number.
    let x = x.max(-FARTHEST).min(FARTHEST);
    // Cheaper than `floor`, which is a call on x86-64 without SSE 4.1.
    let truncated = x as i64;
    let fraction = x - truncated as f64;
    if fraction < 0.0 { (truncated - 1, fraction + 1.0) } else { (truncated, fraction) }
}

#[cfg(test)]
mod tests {
    use relievo_map::HeightMap;
    use relievo_march::{HeightField, ReliefMap};

    use super::*;

    fn hash(x: u32, y: u32) -> f32 {
        ((x.wrapping_mul(2_654_435_761) ^ y.wrapping_mul(40_503)).wrapping_mul(97) >> 8 & 1023) as f32 / 1023.0
    }

    #[test]
    fn ranges_hold_every_height_and_small_ones_are_exact() {
        let map = Grid::from_fn(13, 6, hash);
        let ranges = HeightRanges::build(&map);
        for (wrap, nearest) in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror].map(|w| [(w, false), (w, true)]).concat() {
            for stretched in [None, Some(Bounds { min: [-0.5, 0.0], max: [1.5, 2.0] })] {
                let heights = FilteredMap::new(&map, &ranges, nearest, (wrap, stretched));
                for k in 0..400 {
                    let min = DVec2::new(f64::from(hash(k, 1)) * 60.0 - 30.0, f64::from(hash(k, 2)) * 40.0 - 20.0);
                    let size = DVec2::new(f64::from(hash(k, 3)), f64::from(hash(k, 4)));
                    let small = k % 2 == 0;
                    let size = if small { size * 0.9 } else { size * 15.0 };
                    let [low, high] = heights.range(min, min + size);
                    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
                    for a in 0..=40 {
                        for b in 0..=40 {
                            let at = min + size * DVec2::new(f64::from(a), f64::from(b)) / 40.0;
                            let height = heights.at(at);
                            assert!(low - 1e-12 <= height && height <= high + 1e-12);
                            (least, most) = (least.min(height), most.max(height));
                        }
                    }
                    assert!(
                        !small || nearest || least - low < 0.06 && high - most < 0.06,
                        "{low} {least} {most} {high}"
                    );
                }
            }
        }
    }

    #[test]
    fn nearest_heights_are_those_that_techniques_sample() {
        let map = Grid::from_fn(13, 6, hash);
        let relief = ReliefMap::nearest(&HeightMap::new(map.clone()));
        let (ranges, field) = (HeightRanges::build(&map), relief.field(0.0, Wrap::Mirror));
        let heights = FilteredMap::new(&map, &ranges, true, (Wrap::Mirror, None));
        for k in 0..100 {
            let uv = [hash(k, 5) * 6.0 - 3.0, hash(k, 6) * 6.0 - 3.0];
            let place = heights.place(DVec2::new(f64::from(uv[0]), f64::from(uv[1])));
            assert_eq!(heights.at(place), f64::from(field.sample(uv)));
        }
    }

    #[test]
    fn heights_are_those_that_techniques_sample() {
        let map = Grid::from_fn(13, 6, hash);
        let ranges = HeightRanges::build(&map);
        let heights = FilteredMap::new(&map, &ranges, false, (Wrap::Mirror, None));
        for k in 0..100 {
            let uv = [hash(k, 5) * 6.0 - 3.0, hash(k, 6) * 6.0 - 3.0];
            let place = heights.place(DVec2::new(f64::from(uv[0]), f64::from(uv[1])));
            assert!((heights.at(place) - f64::from(map.sample(uv, Wrap::Mirror))).abs() < 1e-5);
        }
        assert!(heights.at(DVec2::new(f64::NAN, 1e300)).is_finite());
    }
}
