//! Colour maps and the sRGB transfer curve.

use super::grid::Grid;

/// How the numbers of a [`ColorMap`] relate to light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColorEncoding {
    /// The sRGB transfer curve (IEC 61966-2-1); the usual 8-bit picture.
    Srgb,
    /// Proportional to light: EXR, Radiance HDR.
    Linear,
}

/// Colour as it stands in the file: RGBA, 0..1 (above 1 in float files), with its encoding. Alpha is always linear.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorMap {
    /// The texels, RGBA.
    pub grid: Grid<[f32; 4]>,
    /// What the numbers mean.
    pub encoding: ColorEncoding,
}

impl ColorMap {
    /// The colours proportional to light.
    #[must_use]
    pub fn to_linear(&self) -> Grid<[f32; 4]> {
        match self.encoding {
            ColorEncoding::Linear => self.grid.clone(),
            ColorEncoding::Srgb => {
                self.grid.map(|&[r, g, b, a]| [srgb_to_linear(r), srgb_to_linear(g), srgb_to_linear(b), a])
            }
        }
    }

    /// The colours as a display takes them (sRGB curve).
    #[must_use]
    pub fn to_display(&self) -> Grid<[f32; 4]> {
        match self.encoding {
            ColorEncoding::Srgb => self.grid.clone(),
            ColorEncoding::Linear => {
                self.grid.map(|&[r, g, b, a]| [linear_to_srgb(r), linear_to_srgb(g), linear_to_srgb(b), a])
            }
        }
    }
}

/// The sRGB curve's inverse: display value to light, both 0..1 (larger values follow the same power).
#[inline]
#[must_use]
pub fn srgb_to_linear(x: f32) -> f32 {
    if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}

/// The sRGB curve: light to display value, both 0..1 (larger values follow the same power).
#[inline]
#[must_use]
pub fn linear_to_srgb(x: f32) -> f32 {
    if x <= 0.003_130_8 { x * 12.92 } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_srgb_pair_is_inverse() {
        for i in 0..=1000 {
            let x = i as f32 / 1000.0;
            assert!((linear_to_srgb(srgb_to_linear(x)) - x).abs() < 1e-5, "{x}");
        }
    }
}
