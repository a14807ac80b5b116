//! Mean, standard deviation and percentiles of many values.

use rayon::prelude::*;

/// Returns mean and standard deviation, 0 of no values. Sums run by run in a fixed order, independent of threads.
pub(super) fn spread(values: &[f32]) -> (f32, f32) {
    const RUN: usize = 1 << 14;
    let sums: Vec<[f64; 2]> = values
        .par_chunks(RUN)
        .map(|run| run.iter().fold([0.0, 0.0], |[s, q], &v| [s + f64::from(v), q + f64::from(v) * f64::from(v)]))
        .collect();
    let [sum, squares] = sums.iter().fold([0.0, 0.0], |[s, q], [a, b]| [s + a, q + b]);
    let n = values.len().max(1) as f64;
    let mean = sum / n;
    (mean as f32, (squares / n - mean * mean).max(0.0).sqrt() as f32)
}

/// Returns two percentiles; `shares` in percent.
///
/// Counts the values of each of many bins, and sorts those of one bin alone.
pub(super) fn percentiles(values: &[f32], shares: [f32; 2]) -> [f32; 2] {
    const BINS: usize = 1 << 12;
    let (low, high) = values
        .par_iter()
        .fold(|| (f32::MAX, f32::MIN), |(low, high), &v| (low.min(v), high.max(v)))
        .reduce(|| (f32::MAX, f32::MIN), |a, b| (a.0.min(b.0), a.1.max(b.1)));
    if !(high > low) {
        return [low; 2];
    }
    // Rises with the value, so that bins are in order; the cast saturates.
    let bin = |v: f32| ((((v - low) / (high - low)) * BINS as f32) as usize).min(BINS - 1);
    let empty = || vec![0usize; BINS];
    let counts = values
        .par_chunks(1 << 16)
        .fold(empty, |mut counts, run| {
            run.iter().for_each(|&v| counts[bin(v)] += 1);
            counts
        })
        .reduce(empty, |mut a, b| {
            a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
            a
        });
    shares.map(|share| {
        let last = (values.len() - 1) as f64;
        let mut rank = (f64::from(share.max(0.0).min(100.0)) / 100.0 * last).round() as usize;
        let mut wanted = 0;
        while rank >= counts[wanted] {
            rank -= counts[wanted];
            wanted += 1;
        }
        let mut near: Vec<f32> = values.par_iter().copied().filter(|&v| bin(v) == wanted).collect();
        *near.select_nth_unstable_by(rank, f32::total_cmp).1
    })
}
