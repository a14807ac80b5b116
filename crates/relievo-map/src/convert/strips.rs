//! A matrix in strips of columns, whose rows and columns can be transformed by all cores without a second copy.

use rayon::prelude::*;

/// Columns per strip: a cache line of the largest numbers.
const STRIP_WIDTH: usize = 8;
/// Rows that are transformed at once.
const ROW_BATCH: usize = 64;

/// A matrix of numbers in strips of columns.
pub(super) struct Strips<T> {
    columns: usize,
    rows: usize,
    /// Each strip row by row.
    strips: Vec<Vec<T>>,
}

impl<T: Copy + Default + Send + Sync> Strips<T> {
    /// Builds the matrix row by row with `fill`.
    pub(super) fn from_rows<S>(
        columns: usize,
        rows: usize,
        scratch: impl Fn() -> S + Sync + Send,
        fill: impl Fn(&mut S, usize, &mut [T]) + Sync,
    ) -> Self {
        let strip = |k: usize| vec![T::default(); rows * STRIP_WIDTH.min(columns - k * STRIP_WIDTH)];
        let mut strips: Vec<Vec<T>> = (0..columns.div_ceil(STRIP_WIDTH)).map(strip).collect();
        let mut batch = vec![T::default(); columns * ROW_BATCH.min(rows)];
        for first in (0..rows).step_by(ROW_BATCH) {
            let count = ROW_BATCH.min(rows - first);
            let batch = &mut batch[..count * columns];
            batch.par_chunks_mut(columns).enumerate().for_each_init(&scratch, |s, (k, row)| fill(s, first + k, row));
            strips.par_iter_mut().enumerate().for_each(|(k, strip)| {
                let width = strip.len() / rows;
                for (line, row) in strip[first * width..].chunks_exact_mut(width).zip(batch.chunks_exact(columns)) {
                    line.copy_from_slice(&row[k * STRIP_WIDTH..k * STRIP_WIDTH + width]);
                }
            });
        }
        Self { columns, rows, strips }
    }

    /// Transforms every column in place; `change` gets its index and its numbers from the top down.
    pub(super) fn each_column<S>(
        &mut self,
        scratch: impl Fn() -> S + Sync + Send,
        change: impl Fn(&mut S, usize, &mut [T]) + Sync,
    ) {
        let rows = self.rows;
        self.strips.par_iter_mut().enumerate().for_each_init(
            || (scratch(), vec![T::default(); rows]),
            |(s, column), (k, strip)| {
                let width = strip.len() / rows;
                for x in 0..width {
                    for (c, value) in column.iter_mut().zip(strip[x..].iter().step_by(width)) {
                        *c = *value;
                    }
                    change(s, k * STRIP_WIDTH + x, column);
                    for (c, value) in column.iter().zip(strip[x..].iter_mut().step_by(width)) {
                        *value = *c;
                    }
                }
            },
        );
    }

    /// Replaces every number by `f` of its column, its row, itself and the number of `other` there.
    pub(super) fn combine(&mut self, other: &Self, f: impl Fn(usize, usize, T, T) -> T + Sync) {
        let rows = self.rows;
        self.strips.par_iter_mut().zip(&other.strips).enumerate().for_each(|(k, (strip, other))| {
            let width = strip.len() / rows;
            for (i, (a, b)) in strip.iter_mut().zip(other).enumerate() {
                *a = f(k * STRIP_WIDTH + i % width, i / width, *a, *b);
            }
        });
    }

    /// Transforms the rows into rows of `width` numbers each with `make`.
    pub(super) fn into_rows<S>(
        self,
        width: usize,
        scratch: impl Fn() -> S + Sync + Send,
        make: impl Fn(&mut S, &mut [T], &mut [f32]) + Sync,
    ) -> Vec<f32> {
        let mut out = vec![0.0f32; width * self.rows];
        out.par_chunks_mut(width).enumerate().for_each_init(
            || (scratch(), vec![T::default(); self.columns]),
            |(s, row), (y, out)| {
                for (k, strip) in self.strips.iter().enumerate() {
                    let width = strip.len() / self.rows;
                    row[k * STRIP_WIDTH..k * STRIP_WIDTH + width].copy_from_slice(&strip[y * width..(y + 1) * width]);
                }
                make(s, row, out);
            },
        );
        out
    }
}
