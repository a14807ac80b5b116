//! The maxima that packets of rays look up: row by row, so that a lookup is one byte at an index that is cheap to compute.

use rayon::prelude::*;
use relievo_map::Grid;

use super::node::BITS;
use super::quantization::Quantization;

/// The fewest rows for which it is worth while to share the work.
const MIN_ROWS: usize = 32;

/// The windows of one size, row by row: each is twice as wide as their pitch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WindowGrid {
    /// The index of the first among all windows.
    pub(crate) start: usize,
    /// Windows along u and v.
    pub(crate) size: [u32; 2],
    /// Cells from one window to the next.
    pub(crate) pitch: u32,
}

impl WindowGrid {
    fn of(cells: [u32; 2], pitch: u32, start: usize) -> Self {
        Self { start, size: cells.map(|n| n.div_ceil(pitch)), pitch }
    }

    fn end(&self) -> usize {
        self.start + self.size[0] as usize * self.size[1] as usize
    }

    /// Returns the lower corner, and the upper one exclusive, of the windows that hold cells of a rectangle.
    fn touching(&self, [min, max]: [[u32; 2]; 2]) -> [[u32; 2]; 2] {
        [min.map(|n| n.saturating_sub(self.pitch) / self.pitch), max.map(|n| n.div_ceil(self.pitch))]
    }
}

/// The highest points of cells and of windows of cells, in 8 bits with a [`Quantization`] of their own.
///
/// Even steps are too coarse for grazing rays: most cells of a map are often of nearly the same height.
#[derive(Clone, Debug)]
pub(crate) struct WindowMaxima {
    /// Cells along u and v.
    size: [u32; 2],
    quantization: Quantization,
    /// The quantized maximum of each cell.
    cells: Vec<u8>,
    /// The quantized maxima of windows of 4×4, 8×8 and 32×32 cells.
    maxima: Vec<u8>,
    windows_4: WindowGrid,
    windows_8: WindowGrid,
    windows_32: WindowGrid,
    /// The greatest difference between neighbours along u, and along v to the next row, for each row of texels.
    steepest: Vec<f32>,
}

impl WindowMaxima {
    /// Allocates the maxima of this map, which lies between two different heights and will when it changes; not filled yet.
    pub(super) fn new(map: &Grid<f32>, range: [f32; 2]) -> Self {
        let size = [map.width(), map.height()];
        let windows_4 = WindowGrid::of(size, 2, 0);
        let windows_8 = WindowGrid::of(size, 4, windows_4.end());
        let windows_32 = WindowGrid::of(size, 16, windows_8.end());
        Self {
            size,
            quantization: Quantization::new(map, range),
            cells: vec![0; size[0] as usize * size[1] as usize],
            maxima: vec![0; windows_32.end()],
            windows_4,
            windows_8,
            windows_32,
            steepest: vec![0.0; size[1] as usize],
        }
    }

    /// Returns the height of each quantized height.
    pub(crate) fn heights(&self) -> &[f32; 256] {
        self.quantization.heights()
    }

    /// Returns the quantized maxima of cells, row by row.
    pub(crate) fn cells(&self) -> &[u8] {
        &self.cells
    }

    /// Returns the quantized maxima of all windows.
    pub(crate) fn maxima(&self) -> &[u8] {
        &self.maxima
    }

    /// Returns the windows of 4×4 cells, one at every second cell along u and v; parts beyond the map are left out.
    pub(crate) fn windows_4(&self) -> WindowGrid {
        self.windows_4
    }

    /// Returns the windows of 8×8 cells, one at every fourth.
    pub(crate) fn windows_8(&self) -> WindowGrid {
        self.windows_8
    }

    /// Returns the windows of 32×32 cells, one at every sixteenth.
    pub(crate) fn windows_32(&self) -> WindowGrid {
        self.windows_32
    }

    /// Returns the greatest difference in height between neighbouring texels.
    pub(crate) fn steepest(&self) -> f32 {
        self.steepest.iter().copied().fold(0.0, f32::max)
    }

    pub(super) fn bytes(&self) -> usize {
        self.cells.len() + self.maxima.len() + size_of_val(self.steepest.as_slice()) + self.quantization.bytes()
    }

    /// Takes over a rectangle of nodes of level 1 (lower corner, upper corner exclusive), whose texels may have changed.
    pub(super) fn fill(&mut self, map: &Grid<f32>, [min, max]: [[u32; 2]; 2]) {
        let [columns, rows] = self.size.map(|n| n as usize);
        let texels = |y: usize| &map.texels()[y * columns..(y + 1) * columns];
        let [min, max] = [min.map(|n| n << BITS), [0, 1].map(|k| (max[k] << BITS).min(self.size[k]))];
        let [first, last] = [min, max].map(|corner| corner[0] as usize);
        let quantization = &self.quantization;
        let lines = self.cells.par_chunks_mut(columns).zip(&mut self.steepest).enumerate();
        lines.skip(min[1] as usize).take((max[1] - min[1]) as usize).with_min_len(MIN_ROWS).for_each(
            |(y, (cells, steepest))| {
                let (a, b) = (texels(y), texels(if y + 1 == rows { 0 } else { y + 1 }));
                for (x, cell) in (first..).zip(&mut cells[first..last]) {
                    let x1 = if x + 1 == columns { 0 } else { x + 1 };
                    *cell = quantization.quantized(a[x].max(b[x]).max(a[x1].max(b[x1])));
                }
                *steepest = steepest_of(a, b);
            },
        );
        let (maxima_4, rest) = self.maxima.split_at_mut(self.windows_8.start);
        let (maxima_8, maxima_32) = rest.split_at_mut(self.windows_32.start - self.windows_8.start);
        let (rect, cells) = ([min, max], WindowGrid::of(self.size, 1, 0));
        fill_windows(maxima_4, self.windows_4, rect, (&self.cells, cells), [0, 1, 2, 3]);
        fill_windows(maxima_8, self.windows_8, rect, (maxima_4, self.windows_4), [0, 2]);
        fill_windows(maxima_32, self.windows_32, rect, (maxima_8, self.windows_8), [0, 2, 4, 6]);
    }

    /// Distorts all quantized heights, for tests that must notice.
    #[cfg(test)]
    pub(super) fn map_quantized(&mut self, change: impl Fn(u8) -> u8) {
        self.cells.iter_mut().chain(&mut self.maxima).for_each(|height| *height = change(*height));
    }
}

/// Computes the windows that hold cells of a rectangle from smaller ones, or from the cells: from the ones `taken` along both
/// axes, counted from the one where a window begins.
fn fill_windows<const N: usize>(
    maxima: &mut [u8],
    windows: WindowGrid,
    rect: [[u32; 2]; 2],
    (smaller, of): (&[u8], WindowGrid),
    taken: [usize; N],
) {
    let [width, height] = of.size.map(|n| n as usize);
    let spacing = (windows.pitch / of.pitch) as usize;
    let [min, max] = windows.touching(rect);
    let rows = maxima.par_chunks_mut(windows.size[0] as usize).enumerate();
    rows.skip(min[1] as usize).take((max[1] - min[1]) as usize).with_min_len(MIN_ROWS).for_each(|(y, row)| {
        let mut columns = vec![0; width];
        for v in taken {
            let v = (spacing * y + v).min(height - 1);
            columns.iter_mut().zip(&smaller[v * width..][..width]).for_each(|(a, &b)| *a = b.max(*a));
        }
        for (x, maximum) in row.iter_mut().enumerate().take(max[0] as usize).skip(min[0] as usize) {
            *maximum = taken.iter().map(|u| columns[(spacing * x + u).min(width - 1)]).fold(0, u8::max);
        }
    });
}

/// Returns the greatest difference between neighbours in the first of two rows, and to the second.
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
    fn wall(size: [u32; 2], offset: u32) -> Grid<f32> {
        Grid::from_fn(size[0], size[1], |x, y| {
            let (x, y) = (x + offset, y + 2 * offset);
            let face = 0.8 + 0.01 * ((x * 7 + y * 3) as f32).sin();
            match (x % 9, y % 7) {
                (0, _) | (_, 0) => 0.1 + 0.02 * (y % 5) as f32,
                (4, 3) => 1.0,
                (1, _) => 0.5,
                _ => face,
            }
        })
    }

    fn built(map: &Grid<f32>) -> WindowMaxima {
        let mut maxima = WindowMaxima::new(map, [0.1, 1.0]);
        maxima.fill(map, [[0; 2], maxima.size.map(|n| n.div_ceil(4))]);
        maxima
    }

    /// Returns the highest corner of a cell.
    fn corner(map: &Grid<f32>, x: u32, y: u32) -> f32 {
        let size = [map.width(), map.height()];
        let at = |x: u32, y: u32| map.texels()[(y % size[1] * size[0] + x % size[0]) as usize];
        at(x, y).max(at(x + 1, y)).max(at(x, y + 1)).max(at(x + 1, y + 1))
    }

    #[test]
    fn every_height_bounds_its_cell_from_above_and_most_do_so_closely() {
        for size in [[64, 64], [37, 53], [16, 130]] {
            let map = wall(size, 0);
            let maxima = built(&map);
            let mut close = 0;
            for y in 0..size[1] {
                for x in 0..size[0] {
                    let gap =
                        maxima.heights()[usize::from(maxima.cells()[(y * size[0] + x) as usize])] - corner(&map, x, y);
                    // Two hundredths of the range, where heights are rare.
                    assert!((-1e-6..0.02).contains(&gap), "{size:?} {x} {y}: {gap}");
                    close += u32::from(gap < 0.25 / 255.0);
                }
            }
            assert!(close > size[0] * size[1] * 9 / 10, "{size:?}: {close} close ones");
        }
    }

    #[test]
    fn windows_have_the_highest_cell_in_them() {
        for size in [[64, 64], [37, 53], [16, 130]] {
            let maxima = built(&wall(size, 0));
            for (windows, cells) in [(maxima.windows_4(), 4), (maxima.windows_8(), 8), (maxima.windows_32(), 32)] {
                for y in 0..windows.size[1] {
                    for x in 0..windows.size[0] {
                        let inside = |k: usize, n: u32| n * windows.pitch..(n * windows.pitch + cells).min(size[k]);
                        let within = inside(1, y).flat_map(|v| inside(0, x).map(move |u| (u, v)));
                        let highest = within.map(|(u, v)| maxima.cells()[(v * size[0] + u) as usize]).max();
                        let found = maxima.maxima()[windows.start + (y * windows.size[0] + x) as usize];
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
            let partly = Grid::from_fn(size[0], size[1], |x, y| {
                let map = if inside(0, x) && inside(1, y) { &after } else { &before };
                map.texels()[(y * size[0] + x) as usize]
            });
            let mut mended = built(&before);
            let mut whole = mended.clone();
            mended.fill(&partly, [min, max]);
            whole.fill(&partly, [[0; 2], [16, 23]]);
            assert_eq!((mended.cells(), mended.maxima()), (whole.cells(), whole.maxima()), "{min:?} {max:?}");
            assert_eq!(mended.steepest, whole.steepest, "{min:?} {max:?}");
        }
    }

    #[test]
    fn a_flat_map_has_one_height() {
        let map = Grid::from_fn(20, 20, |_, _| 0.5);
        let mut maxima = WindowMaxima::new(&map, [0.0, 1.0]);
        maxima.fill(&map, [[0; 2], [5; 2]]);
        assert!(maxima.cells().iter().all(|&height| maxima.heights()[usize::from(height)] == 0.5));
    }
}
