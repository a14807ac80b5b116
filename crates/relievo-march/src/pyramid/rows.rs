//! The maxima that many rays at once look up: row by row, so that a lookup is one byte at a place that is easily reckoned.

use rayon::prelude::*;
use relievo_map::Grid;

use super::BITS;

/// Rows of which it is not worth while to share the work.
const FEW_ROWS: usize = 32;

/// Steps from the lowest height of a map to the highest, of which codes are chosen.
const STEPS: u32 = 1 << 14;

/// Windows of one size, row by row: each spans twice what it is from one to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Windows {
    /// Where they begin among all.
    pub(crate) start: usize,
    /// How many along u and v.
    pub(crate) size: [u32; 2],
    /// So many cells from one to the next.
    pub(crate) pitch: u32,
}

impl Windows {
    fn of(cells: [u32; 2], pitch: u32, start: usize) -> Self {
        Self { start, size: cells.map(|n| n.div_ceil(pitch)), pitch }
    }

    fn end(&self) -> usize {
        self.start + self.size[0] as usize * self.size[1] as usize
    }

    /// The lower corner, and the upper one exclusive, of those that hold cells of a rectangle.
    fn touching(&self, [min, max]: [[u32; 2]; 2]) -> [[u32; 2]; 2] {
        [min.map(|n| n.saturating_sub(self.pitch) / self.pitch), max.map(|n| n.div_ceil(self.pitch))]
    }
}

/// The highest points of cells and of windows of cells, as codes whose heights lie close where there are many cells.
///
/// A byte with even steps has heights too coarse for rays that graze: most cells of a map are often of nearly the same height.
#[derive(Clone, Debug)]
pub(crate) struct Rows {
    /// Cells along u and v.
    size: [u32; 2],
    coding: Coding,
    /// The code of each cell.
    cells: Vec<u8>,
    /// The highest codes of 4×4, 8×8 and 32×32 cells: see [`Rows::fine`], [`Rows::small`], [`Rows::large`].
    windows: Vec<u8>,
    fine: Windows,
    small: Windows,
    large: Windows,
    /// The greatest difference between neighbours along u, and along v to the next row, for each row of texels.
    steepest: Vec<f32>,
}

/// Which heights codes stand for.
#[derive(Clone, Debug)]
struct Coding {
    /// The lowest height, and steps per unit of height.
    low: f32,
    per_height: f32,
    /// The code of each step.
    codes: Vec<u8>,
    /// The height of each code.
    heights: Box<[f32; 256]>,
}

impl Coding {
    /// For the cells of this map, which lie between two different heights, and will.
    fn new(map: &Grid<f32>, [low, high]: [f32; 2]) -> Self {
        let per_height = STEPS as f32 / (high - low);
        let mut coding = Self { low, per_height, codes: vec![0; STEPS as usize + 1], heights: Box::new([high; 256]) };
        let none = || vec![0u32; coding.codes.len()];
        let size = [map.width() as usize, map.height() as usize];
        // Texels are as good as cells, and fewer rows tell enough.
        let counts = (0..size[1]).into_par_iter().step_by(4).fold(none, |mut counts, y| {
            map.texels()[y * size[0]..(y + 1) * size[0]].iter().for_each(|&h| counts[coding.step(h)] += 1);
            counts
        });
        let counts = counts.reduce(none, |mut a, b| {
            a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
            a
        });
        // A fifth of the codes are spread evenly, for heights that are rare.
        let total: u64 = counts.iter().map(|&count| u64::from(count)).sum();
        let weight = |count: u32| 4 * u64::from(count) * u64::from(STEPS) + total;
        let mut rest: u64 = counts.iter().map(|&count| weight(count)).sum();
        let (mut code, mut taken) = (0u8, 0);
        for (step, &count) in counts.iter().enumerate() {
            coding.codes[step] = code;
            coding.heights[usize::from(code)] = low + step as f32 / per_height;
            taken += weight(count);
            // Its share of what is left, when it began.
            if code < u8::MAX && taken * (256 - u64::from(code)) >= rest {
                (rest, taken, code) = (rest - taken, 0, code + 1);
            }
        }
        // Those that no step has are as high as the highest.
        coding.heights[usize::from(coding.codes[STEPS as usize])..].fill(high);
        coding
    }

    /// The first step that is not below this height, but for the rounding of f32: [`super::SLACK`] is more.
    #[inline]
    fn step(&self, h: f32) -> usize {
        // Not `ceil`, which is a call on processors that are not known to have it.
        (((h - self.low) * self.per_height + (1.0 - 1e-3)) as u32).min(STEPS) as usize
    }
}

impl Rows {
    /// For this map, which lies between two different heights and will when it changes; without content yet.
    pub(super) fn new(map: &Grid<f32>, range: [f32; 2]) -> Self {
        let size = [map.width(), map.height()];
        let fine = Windows::of(size, 2, 0);
        let small = Windows::of(size, 4, fine.end());
        let large = Windows::of(size, 16, small.end());
        Self {
            size,
            coding: Coding::new(map, range),
            cells: vec![0; size[0] as usize * size[1] as usize],
            windows: vec![0; large.end()],
            fine,
            small,
            large,
            steepest: vec![0.0; size[1] as usize],
        }
    }

    /// The heights that codes stand for.
    pub(crate) fn heights(&self) -> &[f32; 256] {
        &self.coding.heights
    }

    /// The codes of cells, row by row.
    pub(crate) fn cells(&self) -> &[u8] {
        &self.cells
    }

    /// The codes of all windows.
    pub(crate) fn windows(&self) -> &[u8] {
        &self.windows
    }

    /// Windows of 4×4 cells, one at every second cell along u and v; what would lie beyond the map is left out.
    pub(crate) fn fine(&self) -> Windows {
        self.fine
    }

    /// Those of 8×8, one at every fourth.
    pub(crate) fn small(&self) -> Windows {
        self.small
    }

    /// Those of 32×32, one at every sixteenth.
    pub(crate) fn large(&self) -> Windows {
        self.large
    }

    /// The greatest difference in height between neighbouring texels.
    pub(crate) fn steepest(&self) -> f32 {
        self.steepest.iter().copied().fold(0.0, f32::max)
    }

    pub(super) fn bytes(&self) -> usize {
        self.cells.len()
            + self.windows.len()
            + size_of_val(self.steepest.as_slice())
            + self.coding.codes.len()
            + size_of_val(self.coding.heights.as_slice())
    }

    /// Takes over a rectangle of nodes of level 1 (lower corner, upper corner exclusive), whose texels may have changed.
    pub(super) fn fill(&mut self, map: &Grid<f32>, [min, max]: [[u32; 2]; 2]) {
        let [columns, rows] = self.size.map(|n| n as usize);
        let texels = |y: usize| &map.texels()[y * columns..(y + 1) * columns];
        let [min, max] = [min.map(|n| n << BITS), [0, 1].map(|k| (max[k] << BITS).min(self.size[k]))];
        let [first, last] = [min, max].map(|corner| corner[0] as usize);
        let coding = &self.coding;
        let lines = self.cells.par_chunks_mut(columns).zip(&mut self.steepest).enumerate();
        lines.skip(min[1] as usize).take((max[1] - min[1]) as usize).with_min_len(FEW_ROWS).for_each(
            |(y, (cells, steepest))| {
                let (a, b) = (texels(y), texels(if y + 1 == rows { 0 } else { y + 1 }));
                for (x, cell) in (first..).zip(&mut cells[first..last]) {
                    let next = if x + 1 == columns { 0 } else { x + 1 };
                    *cell = coding.codes[coding.step(a[x].max(b[x]).max(a[next].max(b[next])))];
                }
                *steepest = steepest_of(a, b);
            },
        );
        let (fine, rest) = self.windows.split_at_mut(self.small.start);
        let (small, large) = rest.split_at_mut(self.large.start - self.small.start);
        let (rect, cells) = ([min, max], Windows::of(self.size, 1, 0));
        fill_windows(fine, self.fine, rect, (&self.cells, cells), [0, 1, 2, 3]);
        fill_windows(small, self.small, rect, (fine, self.fine), [0, 2]);
        fill_windows(large, self.large, rect, (small, self.small), [0, 2, 4, 6]);
    }

    /// Spoils all: for tests that must notice.
    #[cfg(test)]
    pub(super) fn map_codes(&mut self, change: impl Fn(u8) -> u8) {
        self.cells.iter_mut().chain(&mut self.windows).for_each(|code| *code = change(*code));
    }
}

/// Computes the windows that hold cells of a rectangle from smaller ones, or from the cells: from those `taken` along both axes,
/// counted from the one where a window begins.
fn fill_windows<const N: usize>(
    codes: &mut [u8],
    windows: Windows,
    rect: [[u32; 2]; 2],
    (smaller, of): (&[u8], Windows),
    taken: [usize; N],
) {
    let [width, height] = of.size.map(|n| n as usize);
    let spacing = (windows.pitch / of.pitch) as usize;
    let [min, max] = windows.touching(rect);
    let rows = codes.par_chunks_mut(windows.size[0] as usize).enumerate();
    rows.skip(min[1] as usize).take((max[1] - min[1]) as usize).with_min_len(FEW_ROWS).for_each(|(y, row)| {
        let mut columns = vec![0; width];
        for v in taken {
            let v = (spacing * y + v).min(height - 1);
            columns.iter_mut().zip(&smaller[v * width..][..width]).for_each(|(a, &b)| *a = b.max(*a));
        }
        for (x, code) in row.iter_mut().enumerate().take(max[0] as usize).skip(min[0] as usize) {
            *code = taken.iter().map(|u| columns[(spacing * x + u).min(width - 1)]).fold(0, u8::max);
        }
    });
}

/// The greatest difference between neighbours in the first of two rows, and to the second.
fn steepest_of(a: &[f32], b: &[f32]) -> f32 {
    let greatest = |a: &[f32], b: &[f32]| {
        let ((a, rest_a), (b, rest_b)) = (a.as_chunks::<8>(), b.as_chunks::<8>());
        // Lane by lane, as processors have it.
        let mut greatest = [0.0f32; 8];
        for (a, b) in a.iter().zip(b) {
            for k in 0..8 {
                greatest[k] = greatest[k].max((b[k] - a[k]).abs());
            }
        }
        let rest = rest_a.iter().zip(rest_b).map(|(a, b)| (b - a).abs());
        greatest.into_iter().chain(rest).fold(0.0, f32::max)
    };
    let last = a.len() - 1;
    greatest(&a[..last], &a[1..]).max(greatest(a, b)).max((a[last] - a[0]).abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Faces of nearly one height, and slopes and spikes between them.
    fn wall(size: [u32; 2], shift: u32) -> Grid<f32> {
        Grid::from_fn(size[0], size[1], |x, y| {
            let (x, y) = (x + shift, y + 2 * shift);
            let face = 0.8 + 0.01 * ((x * 7 + y * 3) as f32).sin();
            match (x % 9, y % 7) {
                (0, _) | (_, 0) => 0.1 + 0.02 * (y % 5) as f32,
                (4, 3) => 1.0,
                (1, _) => 0.5,
                _ => face,
            }
        })
    }

    fn built(map: &Grid<f32>) -> Rows {
        let mut rows = Rows::new(map, [0.1, 1.0]);
        rows.fill(map, [[0; 2], rows.size.map(|n| n.div_ceil(4))]);
        rows
    }

    /// The highest corner of a cell.
    fn corner(map: &Grid<f32>, x: u32, y: u32) -> f32 {
        let size = [map.width(), map.height()];
        let at = |x: u32, y: u32| map.texels()[(y % size[1] * size[0] + x % size[0]) as usize];
        at(x, y).max(at(x + 1, y)).max(at(x, y + 1)).max(at(x + 1, y + 1))
    }

    #[test]
    fn every_height_bounds_its_cell_from_above_and_most_do_so_closely() {
        for size in [[64, 64], [37, 53], [16, 130]] {
            let map = wall(size, 0);
            let rows = built(&map);
            let mut close = 0;
            for y in 0..size[1] {
                for x in 0..size[0] {
                    let gap =
                        rows.heights()[usize::from(rows.cells()[(y * size[0] + x) as usize])] - corner(&map, x, y);
                    // Two hundredths of the range, where heights are rare.
                    assert!((-1e-6..0.02).contains(&gap), "{size:?} {x} {y}: {gap}");
                    close += u32::from(gap < 0.25 / 255.0);
                }
            }
            assert!(close > size[0] * size[1] * 9 / 10, "{size:?}: {close} close ones");
        }
    }

    #[test]
    fn windows_have_the_highest_code_in_them() {
        for size in [[64, 64], [37, 53], [16, 130]] {
            let rows = built(&wall(size, 0));
            for (windows, cells) in [(rows.fine(), 4), (rows.small(), 8), (rows.large(), 32)] {
                for y in 0..windows.size[1] {
                    for x in 0..windows.size[0] {
                        let inside = |k: usize, n: u32| n * windows.pitch..(n * windows.pitch + cells).min(size[k]);
                        let codes = inside(1, y).flat_map(|v| inside(0, x).map(move |u| (u, v)));
                        let highest = codes.map(|(u, v)| rows.cells()[(v * size[0] + u) as usize]).max();
                        let found = rows.windows()[windows.start + (y * windows.size[0] + x) as usize];
                        assert_eq!(Some(found), highest, "{size:?} {windows:?} {x} {y}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_part_is_mended_as_the_whole_would_be() {
        let size = [61, 90];
        let (before, after) = (wall(size, 0), wall(size, 3));
        for [min, max] in [[[0, 0], [3, 2]], [[5, 7], [9, 8]], [[12, 20], [16, 23]], [[0, 0], [16, 23]]] {
            // The cells of a node have the texels beside it as corners too.
            let inside = |k: usize, n: u32| (4 * min[k] + 1..4 * max[k]).contains(&n);
            let mixed = Grid::from_fn(size[0], size[1], |x, y| {
                let map = if inside(0, x) && inside(1, y) { &after } else { &before };
                map.texels()[(y * size[0] + x) as usize]
            });
            let mut mended = built(&before);
            let mut whole = mended.clone();
            mended.fill(&mixed, [min, max]);
            whole.fill(&mixed, [[0; 2], [16, 23]]);
            assert_eq!((mended.cells(), mended.windows()), (whole.cells(), whole.windows()), "{min:?} {max:?}");
            assert_eq!(mended.steepest, whole.steepest, "{min:?} {max:?}");
        }
    }

    #[test]
    fn a_flat_map_has_one_height() {
        let map = Grid::from_fn(20, 20, |_, _| 0.5);
        let mut rows = Rows::new(&map, [0.0, 1.0]);
        rows.fill(&map, [[0; 2], [5; 2]]);
        assert!(rows.cells().iter().all(|&code| rows.heights()[usize::from(code)] == 0.5));
    }
}
