//! One-dimensional convolution kernels of FLIP: blurs and feature detectors, applied along a column or a row.

/// The symmetry of a kernel: gives its left half from the right half.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Symmetry {
    Even,
    Odd,
}

/// A one-dimensional kernel, stored from its centre outwards.
#[derive(Clone, Debug)]
pub(super) struct FilterKernel {
    half: Vec<f32>,
    symmetry: Symmetry,
}

impl FilterKernel {
    /// A Gaussian of standard deviation `sd` pixels, cut at `radius` and made to sum to 1; and what it summed to before,
    /// where its peak was 1.
    pub(super) fn gaussian(sd: f64, radius: usize) -> (Self, f64) {
        let half = bell(sd, radius);
        let sum = half[0] + 2.0 * half[1..].iter().sum::<f64>();
        (Self::new(half.iter().map(|w| w / sum), Symmetry::Even), sum)
    }

    /// The first derivative of that Gaussian: finds edges. Each half sums to 1 in magnitude.
    pub(super) fn edge(sd: f64, radius: usize) -> Self {
        let slope: Vec<f64> = bell(sd, radius).iter().enumerate().map(|(x, g)| x as f64 * g).collect();
        let sum: f64 = slope.iter().sum();
        Self::new(slope.iter().map(|w| w / sum), Symmetry::Odd)
    }

    /// The second derivative of that Gaussian: finds points and lines. Its positive weights sum to 1, its negative ones
    /// to −1.
    pub(super) fn point(sd: f64, radius: usize) -> Self {
        let curve = bell(sd, radius);
        let curve = curve.iter().enumerate().map(|(x, g)| ((x as f64 / sd).powi(2) - 1.0) * g);
        let (mut above, mut below) = (0.0, 0.0);
        for (x, w) in curve.clone().enumerate() {
            let both_sides = if x == 0 { w } else { 2.0 * w };
            *(if w > 0.0 { &mut above } else { &mut below }) += both_sides;
        }
        Self::new(curve.map(|w| if w > 0.0 { w / above } else { w / -below }), Symmetry::Even)
    }

    fn new(half: impl Iterator<Item = f64>, symmetry: Symmetry) -> Self {
        let mut half: Vec<f32> = half.map(|w| w as f32).collect();
        // Tails this far under the peak cannot move a sum in f32.
        let floor = half.iter().fold(0.0f32, |max, w| max.max(w.abs())) * 1e-9;
        half.truncate(half.iter().rposition(|w| w.abs() > floor).map_or(1, |last| last + 1));
        Self { half, symmetry }
    }

    /// The radius in pixels.
    pub(super) fn radius(&self) -> usize {
        self.half.len() - 1
    }

    /// Computes one row of a picture filtered down its columns; `row(i)` is the row `i` below the wanted one (above for i < 0).
    pub(super) fn filter_columns<'a>(&self, out: &mut [f32], row: impl Fn(isize) -> &'a [f32]) {
        match self.symmetry {
            Symmetry::Even => self.accumulate(out, row, |before, after| after + before),
            Symmetry::Odd => self.accumulate(out, row, |before, after| after - before),
        }
    }

    /// Filters a row along itself; `padded` holds `pad ≥ radius` further numbers before and after it.
    pub(super) fn filter_row(&self, out: &mut [f32], padded: &[f32], pad: usize) {
        let width = out.len();
        self.filter_columns(out, |i| &padded[pad.wrapping_add_signed(i)..][..width]);
    }

    #[inline(always)]
    fn accumulate<'a>(&self, out: &mut [f32], row: impl Fn(isize) -> &'a [f32], fold: impl Fn(f32, f32) -> f32 + Copy) {
        for (out, &centre) in out.iter_mut().zip(row(0)) {
            *out = self.half[0] * centre;
        }
        // Two taps a turn, so the sums are read and written half as often.
        let mut taps = (1isize..).zip(&self.half[1..]);
        while let Some((i, &w)) = taps.next() {
            match taps.next() {
                Some((j, &v)) => add_pairs(out, [w, v], [row(-i), row(-j)], [row(i), row(j)], fold),
                None => add_pairs(out, [w], [row(-i)], [row(i)], fold),
            }
        }
    }
}

#[inline(always)]
fn add_pairs<const N: usize>(
    out: &mut [f32],
    weights: [f32; N],
    before: [&[f32]; N],
    after: [&[f32]; N],
    fold: impl Fn(f32, f32) -> f32,
) {
    // Equal lengths known up front let the compiler use its vector registers.
    let n = out.len();
    let (before, after) = (before.map(|row| &row[..n]), after.map(|row| &row[..n]));
    for (x, out) in out.iter_mut().enumerate() {
        let mut sum = 0.0;
        for k in 0..N {
            sum += weights[k] * fold(before[k][x], after[k][x]);
        }
        *out += sum;
    }
}

/// The right half of a Gaussian with peak 1.
fn bell(sd: f64, radius: usize) -> Vec<f64> {
    (0..=radius).map(|x| (-0.5 * (x as f64 / sd).powi(2)).exp()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filter(kernel: &FilterKernel, row: &[f32]) -> Vec<f32> {
        let pad = kernel.radius();
        let clamped = |i: isize| row[(i - pad as isize).clamp(0, row.len() as isize - 1) as usize];
        let padded: Vec<f32> = (0..(row.len() + 2 * pad) as isize).map(clamped).collect();
        let mut out = vec![0.0; row.len()];
        kernel.filter_row(&mut out, &padded, pad);
        out
    }

    #[test]
    fn a_blur_keeps_constants_and_detectors_do_not_see_them() {
        let flat = [0.75; 9];
        for x in filter(&FilterKernel::gaussian(2.7, 9).0, &flat) {
            assert!((x - 0.75).abs() < 1e-6, "{x}");
        }
        for kernel in [FilterKernel::edge(2.7, 9), FilterKernel::point(2.7, 9)] {
            for x in filter(&kernel, &flat) {
                assert!(x.abs() < 1e-6, "{x}");
            }
        }
    }

    #[test]
    fn an_impulse_brings_out_the_kernel_with_its_symmetry() {
        let mut impulse = [0.0; 31];
        impulse[15] = 1.0;
        for (kernel, sign) in [
            (FilterKernel::gaussian(1.6, 8).0, 1.0),
            (FilterKernel::edge(1.6, 8), -1.0),
            (FilterKernel::point(1.6, 8), 1.0),
        ] {
            let out = filter(&kernel, &impulse);
            for i in 1..=8 {
                assert_eq!(out[15 + i], sign * out[15 - i]);
            }
            assert!(out[15 + 3].abs() > 1e-3 && out[15 + 9] == 0.0);
        }
    }

    #[test]
    fn a_step_from_black_to_white_is_a_full_edge() {
        let mut step = [0.0; 40];
        step[20..].fill(1.0);
        let out = filter(&FilterKernel::edge(2.0, 6), &step);
        let peak = out.iter().fold(0.0f32, |max, &x| max.max(x.abs()));
        assert!((peak - 1.0).abs() < 1e-6, "{peak}");
        assert!(out[..13].iter().all(|x| x.abs() < 1e-6));
    }

    #[test]
    fn tails_that_cannot_matter_are_cut() {
        assert!(FilterKernel::gaussian(1.0, 50).0.radius() < 8);
        assert_eq!(FilterKernel::gaussian(0.01, 5).0.radius(), 0);
    }
}
