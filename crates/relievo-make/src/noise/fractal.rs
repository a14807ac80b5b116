//! Sums of octaves: fractional Brownian motion, ridges and billows, all exactly periodic.

use rayon::prelude::*;
use relievo_map::{Grid, GridError};

use super::basis::{Basis, Noise, Octave};
use super::fbm::visible_fraction;

/// Combination of the octaves of a [`Fractal`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum FractalKind {
    /// Their sum: fractional Brownian motion. Keeps the mean and the standard deviation of one octave.
    #[default]
    Fbm,
    /// Sharp crests: each octave is (1 − |n|)², weighted by the crest it stands on (Musgrave's ridged multifractal, in
    /// Ebert et al., "Texturing and Modeling", 1994). 0 to about 1.
    Ridged,
    /// Round bellies with sharp valleys: octaves of |n|. 0 to about 1.
    Billow,
}

impl FractalKind {
    /// All kinds and their names in recipes.
    pub const ALL: [(&'static str, Self); 3] = [("fbm", Self::Fbm), ("ridged", Self::Ridged), ("billow", Self::Billow)];
}

/// Octaves of a noise, each twice as fine as the one before; none is finer than the texels can show.
///
/// A larger map shows the same design with more octaves, a smaller one fades out those that it cannot show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fractal {
    /// The coarsest octave.
    pub noise: Noise,
    /// Combination of the octaves.
    pub kind: FractalKind,
    /// Octaves, 1 to [`Fractal::MAX_OCTAVES`].
    pub octaves: u32,
    /// Each octave has `gain` times the amplitude of the one before, 0 to 1.
    pub gain: f32,
}

impl Fractal {
    /// The most octaves; more than any map can show.
    pub const MAX_OCTAVES: u32 = 14;

    /// Samples the noise at (u, v), for texels of the size `texel` in uv; 0 shows every octave. `phase` is that of its loop: 0
    /// the beginning, 1 the same again.
    #[must_use]
    pub fn at(&self, u: f32, v: f32, texel: f32, phase: f64) -> f32 {
        self.sample(&self.octaves(texel, phase), u, v)
    }

    /// Samples the octaves that texels of some size can show, at (u, v).
    pub(crate) fn sample(&self, octaves: &[(Octave, f32)], u: f32, v: f32) -> f32 {
        let mut sum = Sum::new(self.kind, self.gain, self.octaves);
        for (octave, shown) in octaves {
            let n = if *shown > 0.0 { octave.at(u, v) } else { 0.0 };
            sum.add(n - octave.basis.mean(), n, *shown);
        }
        sum.total(self.noise.basis.mean())
    }

    /// Returns the octaves at a phase of the loop, and the fraction of each that texels of this size can show.
    pub(crate) fn octaves(&self, texel: f32, phase: f64) -> Vec<(Octave, f32)> {
        let base = self.noise;
        let octaves = (0..self.octaves.min(Self::MAX_OCTAVES)).map_while(|k| {
            let (columns, rows) = (base.columns.checked_mul(1 << k)?, base.rows.checked_mul(1 << k)?);
            let octave = Noise { columns, rows, seed: base.seed.wrapping_add(k * 0x9e37), ..base };
            Some((Octave::new(&octave, phase), visible_fraction(columns.max(rows), texel)))
        });
        octaves.collect()
    }

    /// Divisor of the sum of all octaves.
    pub(crate) fn whole(&self) -> f32 {
        whole(self.kind, self.gain, self.octaves)
    }

    /// Fills `out` with the row at `v`; its texel x lies at u = (x + 0.5) / length. The same as [`Fractal::at`] for each
    /// texel, but faster.
    pub fn row(&self, v: f32, phase: f64, out: &mut [f32]) {
        let texel = 1.0 / out.len() as f32;
        let octaves = self.octaves(texel, phase);
        if self.noise.basis == Basis::Perlin && self.kind == FractalKind::Fbm {
            out.fill(0.0);
            for (k, (octave, shown)) in octaves.iter().enumerate().take_while(|(_, (_, shown))| *shown > 0.0) {
                let amplitude = shown * self.gain.powi(k as i32) / energy(self.gain, self.octaves).sqrt();
                octave.gradients().add_row(v, amplitude, out);
            }
            return;
        }
        for (x, out) in out.iter_mut().enumerate() {
            *out = self.sample(&octaves, (x as f32 + 0.5) * texel, v);
        }
    }

    /// Renders the noise to a grid of `width × height` texels that tiles, at the beginning of its loop.
    ///
    /// # Errors
    /// If a side is 0 or over [`Grid::MAX_SIDE`].
    pub fn grid(&self, width: u32, height: u32) -> Result<Grid<f32>, GridError> {
        if width == 0 || height == 0 || width.max(height) > Grid::<f32>::MAX_SIDE {
            return Err(GridError::Size { width, height });
        }
        let mut texels = vec![0.0; width as usize * height as usize];
        texels.par_chunks_mut(width as usize).enumerate().for_each(|(y, row)| {
            self.row((y as f32 + 0.5) / height as f32, 0.0, row);
        });
        Grid::new(width, height, texels)
    }
}

fn energy(gain: f32, octaves: u32) -> f32 {
    (0..octaves).map(|k| gain.powi(2 * k as i32)).sum()
}

/// Divisor of a sum of octaves: their energy or weight.
fn whole(kind: FractalKind, gain: f32, octaves: u32) -> f32 {
    match kind {
        FractalKind::Fbm => energy(gain, octaves).sqrt(),
        FractalKind::Ridged | FractalKind::Billow => (0..octaves).map(|k| gain.powi(k as i32)).sum(),
    }
}

/// Accumulator of octaves.
struct Sum {
    kind: FractalKind,
    gain: f32,
    whole: f32,
    amplitude: f32,
    total: f32,
    /// The crest that the next octave stands on.
    crest: f32,
}

impl Sum {
    fn new(kind: FractalKind, gain: f32, octaves: u32) -> Self {
        Self { kind, gain, whole: whole(kind, gain, octaves), amplitude: 1.0, total: 0.0, crest: 1.0 }
    }

    /// Adds the next octave: its value `n`, `off` from its mean, of which the fraction `shown` is visible.
    fn add(&mut self, off: f32, n: f32, shown: f32) {
        match self.kind {
            FractalKind::Fbm => self.total += self.amplitude * off * shown,
            FractalKind::Ridged => {
                let ridge = (1.0 - n.abs()).max(0.0);
                let signal = ridge * ridge * self.crest;
                // About the mean of a crest: what fades out leaves the level.
                let level = 0.52 * self.crest;
                let signal = level + (signal - level) * shown;
                self.total += self.amplitude * signal;
                self.crest = (2.0 * signal).min(1.0);
            }
            FractalKind::Billow => {
                let level = 0.27;
                self.total += self.amplitude * (level + (n.abs() - level) * shown);
            }
        }
        self.amplitude *= self.gain;
    }

    fn total(&self, mean: f32) -> f32 {
        self.total / self.whole + if self.kind == FractalKind::Fbm { mean } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fractal(kind: FractalKind, basis: Basis) -> Fractal {
        Fractal { noise: Noise { basis, columns: 4, rows: 3, seed: 5, time_cells: 3 }, kind, octaves: 6, gain: 0.5 }
    }

    #[test]
    fn a_row_equals_its_points() {
        for (_, kind) in FractalKind::ALL {
            for (_, basis) in Basis::ALL {
                let fractal = fractal(kind, basis);
                let mut row = vec![0.0; 96];
                fractal.row(0.3, 0.4, &mut row);
                for (x, value) in row.iter().enumerate() {
                    let expected = fractal.at((x as f32 + 0.5) / 96.0, 0.3, 1.0 / 96.0, 0.4);
                    assert!((value - expected).abs() < 1e-4, "{kind:?} {basis:?} {x}: {value} for {expected}");
                }
            }
        }
    }

    #[test]
    fn twice_the_size_is_the_same_design_with_more_detail() {
        for (_, kind) in FractalKind::ALL {
            let fractal = fractal(kind, Basis::Perlin);
            let (small, large) = (fractal.grid(64, 64).unwrap(), fractal.grid(128, 128).unwrap());
            let (mut off, mut spread, mut detail) = (0.0, 0.0, 0.0);
            let mean = small.texels().iter().sum::<f32>() / 4096.0;
            for y in 0..64 {
                for x in 0..64 {
                    let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| *large.get(2 * x + i, 2 * y + j));
                    let average = four.iter().sum::<f32>() / 4.0;
                    off += (small.get(x, y) - average).powi(2);
                    spread += (small.get(x, y) - mean).powi(2);
                    detail += four.iter().map(|f| (f - average).powi(2)).sum::<f32>() / 4.0;
                }
            }
            assert!(off < 0.03 * spread, "{kind:?}: {}", off / spread);
            assert!(detail > 0.0);
        }
    }

    #[test]
    fn the_seam_is_like_the_inside() {
        for (_, kind) in FractalKind::ALL {
            for (_, basis) in Basis::ALL {
                let grid = fractal(kind, basis).grid(128, 128).unwrap();
                let step = |x: u32| (0..128).map(|y| (grid.get(x, y) - grid.get((x + 1) % 128, y)).abs()).sum::<f32>();
                let worst = (0..127).map(step).fold(0.0, f32::max);
                assert!(step(127) <= worst, "{kind:?} {basis:?}");
            }
        }
    }

    #[test]
    fn impossible_sizes_are_refused() {
        let fractal = fractal(FractalKind::Fbm, Basis::Perlin);
        assert!(fractal.grid(0, 4).is_err() && fractal.grid(4, 1 << 20).is_err());
    }
}
