//! Bilinear sampling and area averages of grids.

use super::grid::Grid;
use super::wrap::Wrap;

/// A texel that can be filtered: interpolated and summed with weights.
pub trait Texel: Copy + Send + Sync {
    /// Interpolates: `self + (other − self)·t`.
    #[must_use]
    fn lerp(self, other: Self, t: f32) -> Self;
    /// Adds with a weight: `self + other·weight`.
    #[must_use]
    fn add_scaled(self, other: Self, weight: f32) -> Self;
    /// The neutral start of a weighted sum.
    const ZERO: Self;
}

impl Texel for f32 {
    const ZERO: Self = 0.0;
    #[inline]
    fn lerp(self, other: Self, t: f32) -> Self {
        self + (other - self) * t
    }
    #[inline]
    fn add_scaled(self, other: Self, weight: f32) -> Self {
        self + other * weight
    }
}

impl<const N: usize> Texel for [f32; N] {
    const ZERO: Self = [0.0; N];
    #[inline]
    fn lerp(self, other: Self, t: f32) -> Self {
        std::array::from_fn(|k| self[k].lerp(other[k], t))
    }
    #[inline]
    fn add_scaled(self, other: Self, weight: f32) -> Self {
        std::array::from_fn(|k| self[k].add_scaled(other[k], weight))
    }
}

impl<T: Texel> Grid<T> {
    /// Samples bilinearly at `uv` (in repeats; (0, 0) = top-left corner of the top-left texel).
    ///
    /// Coordinates that are not finite give an unspecified value of the map.
    #[inline]
    #[must_use]
    pub fn sample(&self, uv: [f32; 2], wrap: Wrap) -> T {
        self.sample_with(uv, wrap, T::lerp)
    }

    /// Samples as [`Grid::sample`] does, with another interpolation between neighbours: along u for both rows, then
    /// along v.
    #[inline]
    #[must_use]
    pub fn sample_with(&self, uv: [f32; 2], wrap: Wrap, lerp: impl Fn(T, T, f32) -> T) -> T {
        let (i, a) = bilinear_cell(uv[0], self.width());
        let (j, b) = bilinear_cell(uv[1], self.height());
        let (x0, x1) = (wrap.index(i, self.width()), wrap.index(i.wrapping_add(1), self.width()));
        let (y0, y1) = (wrap.index(j, self.height()), wrap.index(j.wrapping_add(1), self.height()));
        let top = lerp(*self.get(x0, y0), *self.get(x1, y0), a);
        let bottom = lerp(*self.get(x0, y1), *self.get(x1, y1), a);
        lerp(top, bottom, b)
    }

    /// Returns the grid at half the size (odd sides are rounded down, at least 1), each texel the mean of its area.
    #[must_use]
    pub fn halved(&self) -> Self {
        let (w, h) = ((self.width() / 2).max(1), (self.height() / 2).max(1));
        let columns: Vec<_> = (0..w).map(|x| coverage(x, w, self.width())).collect();
        let rows: Vec<_> = (0..h).map(|y| coverage(y, h, self.height())).collect();
        Self::from_fn(w, h, |x, y| {
            let mut sum = T::ZERO;
            for &(row, row_weight) in &rows[y as usize] {
                for &(column, weight) in &columns[x as usize] {
                    sum = sum.add_scaled(*self.get(column, row), weight * row_weight);
                }
            }
            sum
        })
    }
}

/// Returns the texel left of (or above) coordinate `u` and the fraction towards its neighbour.
#[inline]
fn bilinear_cell(u: f32, size: u32) -> (i32, f32) {
    let x = u * size as f32 - 0.5;
    // Cheaper than `floor`, which is a call on x86-64 without SSE 4.1. The cast saturates, and turns NaN into 0.
    let truncated = x as i32;
    let fraction = x - truncated as f32;
    let (i, fraction) =
        if fraction < 0.0 { (truncated.wrapping_sub(1), fraction + 1.0) } else { (truncated, fraction) };
    // Beyond 2³¹ nothing is left of the fraction, and NaN becomes 0.
    (i, fraction.max(0.0).min(1.0))
}

/// Returns the texels of a line of `from` that texel `x` of a line of `to` covers, with weights that sum to 1.
fn coverage(x: u32, to: u32, from: u32) -> Vec<(u32, f32)> {
    let scale = f64::from(from) / f64::from(to);
    let (start, end) = (f64::from(x) * scale, f64::from(x + 1) * scale);
    (start as u32..from.min(end.ceil() as u32))
        .map(|i| (i, (((f64::from(i) + 1.0).min(end) - f64::from(i).max(start)) / scale) as f32))
        .filter(|&(_, weight)| weight > 0.0)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bilinear_samples_meet_the_texels_at_their_centres_and_wrap_between_them() {
        let grid = Grid::new(2, 1, vec![0.0f32, 1.0]).unwrap();
        assert_eq!(grid.sample([0.25, 0.5], Wrap::Repeat), 0.0);
        assert_eq!(grid.sample([0.75, 7.5], Wrap::Repeat), 1.0);
        assert_eq!(grid.sample([0.5, 0.5], Wrap::Repeat), 0.5);
        assert_eq!(grid.sample([0.0, 0.5], Wrap::Repeat), 0.5);
        assert_eq!(grid.sample([0.0, 0.5], Wrap::Clamp), 0.0);
        assert_eq!(grid.sample([-0.25, 0.5], Wrap::Repeat), 1.0);
        assert_eq!(grid.sample([-0.5, 0.5], Wrap::Repeat), 0.5);
        for odd in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, -3e9] {
            assert!((0.0..=1.0).contains(&grid.sample([odd, odd], Wrap::Mirror)), "{odd}");
        }
    }
}
