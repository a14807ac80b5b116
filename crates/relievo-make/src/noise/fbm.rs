//! Fractional Brownian motion (fBm) of gradient noise, a row at a time.

use super::lattice::GradientNoise;

/// Octaves of gradient noise, each twice as fine as the one before, none finer than the texels can show.
#[derive(Clone, Copy)]
pub(crate) struct Fbm {
    base: GradientNoise,
    octaves: u32,
    gain: f32,
}

impl Fbm {
    /// Creates a sum of `octaves`, the first of which is `base`; each has `gain` times the amplitude of the one before. The
    /// sum is scaled to keep the standard deviation of a single octave.
    pub(crate) fn new(base: GradientNoise, octaves: u32, gain: f32) -> Self {
        Self { base, octaves, gain }
    }

    /// Returns every octave that a map with texels of `texel` (in uv) can show, with its amplitude.
    ///
    /// Scaled by the energy of *all* octaves: a smaller map loses detail and keeps the rest as it is.
    fn visible_octaves(&self, texel: f32) -> impl Iterator<Item = (GradientNoise, f32)> {
        let Self { base, octaves, gain } = *self;
        let energy: f32 = (0..octaves).map(|k| gain.powi(2 * k as i32)).sum();
        (0..octaves)
            .map(move |k| {
                let layer = GradientNoise::new(base.columns << k, base.rows << k, base.seed.wrapping_add(k * 0x9e37));
                let shown = visible_fraction(layer.columns.max(layer.rows), texel);
                (layer, shown * gain.powi(k as i32) / energy.sqrt())
            })
            .take_while(|&(_, amplitude)| amplitude > 0.0)
    }

    /// Fills `out` with the row at `v`.
    pub(crate) fn row(&self, v: f32, out: &mut [f32]) {
        out.fill(0.0);
        let texel = 1.0 / out.len() as f32;
        for (layer, amplitude) in self.visible_octaves(texel) {
            layer.add_row(v, amplitude, out);
        }
    }
}

/// Returns the fraction of a noise with `cells` per repeat that texels of `texel` can show: 1 where a cell has three texels
/// or more, 0 below one and a half, where it would alias.
pub(crate) fn visible_fraction(cells: u32, texel: f32) -> f32 {
    let texels_per_cell = 1.0 / (cells as f32 * texel);
    ((texels_per_cell - 1.5) / 1.5).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_has_mean_zero_and_a_standard_deviation_of_a_third() {
        let noise = Fbm::new(GradientNoise::new(16, 16, 1), 3, 0.5);
        let mut values = Vec::new();
        let mut row = vec![0.0; 512];
        for y in 0..512 {
            noise.row((y as f32 + 0.5) / 512.0, &mut row);
            values.extend_from_slice(&row);
        }
        let mean = values.iter().sum::<f32>() / values.len() as f32;
        let deviation = (values.iter().map(|v| (v - mean).powi(2)).sum::<f32>() / values.len() as f32).sqrt();
        assert!(mean.abs() < 0.03, "{mean}");
        assert!((0.28..0.38).contains(&deviation), "{deviation}");
    }

    #[test]
    fn octaves_finer_than_the_texels_are_left_out() {
        let texel = 1.0 / 64.0;
        let coarse = Fbm::new(GradientNoise::new(8, 8, 5), 1, 0.5);
        let all = Fbm::new(GradientNoise::new(8, 8, 5), 8, 0.5);
        assert_eq!(coarse.visible_octaves(texel).count(), 1);
        // 8, 16 and 32 cells; 64 would have one texel per cell.
        assert_eq!(all.visible_octaves(texel).count(), 3);
    }
}
