//! Mip pyramids and trilinear sampling.

use super::grid::Grid;
use super::sample::Texel;
use super::wrap::Wrap;

/// A map with all its smaller versions, level 0 the map itself, each level half the one before, the last 1×1.
#[derive(Clone, Debug, PartialEq)]
pub struct MipMap<T> {
    levels: Vec<Grid<T>>,
}

impl<T: Texel> MipMap<T> {
    /// Only level 0: for maps that are never minified.
    #[must_use]
    pub fn single(base: Grid<T>) -> Self {
        Self { levels: vec![base] }
    }

    /// All levels down to 1×1, by area average (Williams 1983).
    #[must_use]
    pub fn build(base: Grid<T>) -> Self {
        let mut levels = vec![base];
        while let Some(last) = levels.last()
            && (last.width() > 1 || last.height() > 1)
        {
            let next = last.halved();
            levels.push(next);
        }
        Self { levels }
    }

    /// Each level, by its number, changed by `f` into one of the same size.
    #[must_use]
    pub(crate) fn map_levels<U>(&self, f: impl Fn(usize, &Grid<T>) -> Grid<U>) -> MipMap<U> {
        MipMap { levels: self.levels.iter().enumerate().map(|(level, grid)| f(level, grid)).collect() }
    }

    /// The levels, the largest first.
    #[must_use]
    pub fn levels(&self) -> &[Grid<T>] {
        &self.levels
    }

    /// Level 0.
    #[inline]
    #[must_use]
    pub fn base(&self) -> &Grid<T> {
        &self.levels[0]
    }

    /// The trilinearly filtered value at `uv`: bilinear in the two levels around `lod`, then mixed. `lod` is clamped to
    /// the levels there are; NaN counts as 0.
    #[inline]
    #[must_use]
    pub fn sample(&self, uv: [f32; 2], lod: f32, wrap: Wrap) -> T {
        // Written so that NaN takes the first branch.
        if !(lod > 0.0) {
            return self.levels[0].sample(uv, wrap);
        }
        let last = self.levels.len() - 1;
        let level = (lod as usize).min(last);
        let value = self.levels[level].sample(uv, wrap);
        let fraction = lod - level as f32;
        if level == last || fraction == 0.0 {
            return value;
        }
        value.lerp(self.levels[level + 1].sample(uv, wrap), fraction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_level_keeps_the_mean_also_with_odd_sides() {
        let base = Grid::from_fn(13, 6, |x, y| (x * 7 + y * 3) as f32 % 5.0);
        let mean = |g: &Grid<f32>| g.texels().iter().sum::<f32>() / g.texels().len() as f32;
        let mips = MipMap::build(base.clone());
        assert_eq!(mips.levels().len(), 4);
        for level in mips.levels() {
            assert!((mean(level) - mean(&base)).abs() < 1e-5);
        }
    }

    #[test]
    fn trilinear_lies_between_the_two_levels() {
        let mips = MipMap::build(Grid::from_fn(8, 8, |x, y| (x ^ y) as f32));
        let uv = [0.3, 0.4];
        let (a, b) = (mips.sample(uv, 1.0, Wrap::Repeat), mips.sample(uv, 2.0, Wrap::Repeat));
        assert!((mips.sample(uv, 1.25, Wrap::Repeat) - (a + (b - a) * 0.25)).abs() < 1e-6);
        assert_eq!(mips.sample(uv, f32::NAN, Wrap::Repeat), mips.sample(uv, 0.0, Wrap::Repeat));
        assert_eq!(mips.sample(uv, 99.0, Wrap::Repeat), *mips.levels()[3].get(0, 0));
    }
}
