//! A rectangle of numbers in strips of columns, so that its rows and its columns can be worked on by all cores without a
//! second copy.

use rayon::prelude::*;

/// Columns per strip: a cache line of the largest numbers.
const WIDTH: usize = 8;
/// Rows that are worked on at once.
const BATCH: usize = 64;

pub(super) struct Strips<T> {
    columns: usize,
    rows: usize,
    /// Each row by row.
    strips: Vec<Vec<T>>,
}

impl<T: Copy + Default + Send + Sync> Strips<T> {
    /// The rectangle whose row y is what `fill` makes of it.
    pub(super) fn from_rows<S>(
        columns: usize,
        rows: usize,
        scratch: impl Fn() -> S + Sync + Send,
        fill: impl Fn(&mut S, usize, &mut [T]) + Sync,
    ) -> Self {
        let strip = |k: usize| vec![T::default(); rows * WIDTH.min(columns - k * WIDTH)];
        let mut strips: Vec<Vec<T>> = (0..columns.div_ceil(WIDTH)).map(strip).collect();
        let mut batch = vec![T::default(); columns * BATCH.min(rows)];
        for first in (0..rows).step_by(BATCH) {
            let count = BATCH.min(rows - first);
            let batch = &mut batch[..count * columns];
            batch.par_chunks_mut(columns).enumerate().for_each_init(&scratch, |s, (k, row)| fill(s, first + k, row));
            strips.par_iter_mut().enumerate().for_each(|(k, strip)| {
                let width = strip.len() / rows;
                for (line, row) in strip[first * width..].chunks_exact_mut(width).zip(batch.chunks_exact(columns)) {
                    line.copy_from_slice(&row[k * WIDTH..k * WIDTH + width]);
                }
            });
        }
        Self { columns, rows, strips }
    }

    /// Changes every column: its number and its numbers from the top down.
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
                    change(s, k * WIDTH + x, column);
                    for (c, value) in column.iter().zip(strip[x..].iter_mut().step_by(width)) {
                        *value = *c;
                    }
                }
            },
        );
    }

    /// Changes every number by its column, its row and the number that `other` has there.
    pub(super) fn combine(&mut self, other: &Self, f: impl Fn(usize, usize, T, T) -> T + Sync) {
        let rows = self.rows;
        self.strips.par_iter_mut().zip(&other.strips).enumerate().for_each(|(k, (strip, other))| {
            let width = strip.len() / rows;
            for (i, (a, b)) in strip.iter_mut().zip(other).enumerate() {
                *a = f(k * WIDTH + i % width, i / width, *a, *b);
            }
        });
    }

    /// Rows of `width` numbers each, made from the rectangle's rows by `make`.
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
                    row[k * WIDTH..k * WIDTH + width].copy_from_slice(&strip[y * width..(y + 1) * width]);
                }
                make(s, row, out);
            },
        );
        out
    }
}
