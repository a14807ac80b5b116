//! The hints of a photograph: light, saturation and the likeness of a colour, one number per texel.

use rayon::prelude::*;
use relievo_map::{ColorEncoding, ColorMap, Grid, GridError, srgb_to_linear};

use super::options::ColorPick;
use super::statistics::spread;

/// Decoder of stored colours to linear light.
struct LinearDecoder {
    /// The sRGB curve at 1024 steps, interpolated linearly: error below 4e-7, faster than its power. Empty for linear files.
    curve: Vec<f32>,
}

impl LinearDecoder {
    const STEPS: usize = 1024;

    fn new(encoding: ColorEncoding) -> Self {
        let srgb = encoding == ColorEncoding::Srgb;
        let steps = if srgb { 0..Self::STEPS + 2 } else { 0..0 };
        Self { curve: steps.map(|k| srgb_to_linear(k as f32 / Self::STEPS as f32)).collect() }
    }

    fn of(&self, stored: f32) -> f32 {
        // `max` first: it also turns NaN into 0.
        let c = stored.max(0.0).min(1e4);
        if self.curve.is_empty() || c > 1.0 {
            return c;
        }
        let x = c * Self::STEPS as f32;
        let k = x as usize;
        self.curve[k] + (self.curve[k + 1] - self.curve[k]) * (x - k as f32)
    }
}

fn luminance([r, g, b]: [f32; 3]) -> f32 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// Computes a number for each texel from its linear colour. Where the picture is transparent it is the mean.
fn each(photo: &ColorMap, f: impl Fn([f32; 3]) -> f32 + Sync) -> Result<Grid<f32>, GridError> {
    let light = LinearDecoder::new(photo.encoding);
    let texels = photo.grid.texels();
    let mut values: Vec<f32> = texels.par_iter().map(|&[r, g, b, _]| f([r, g, b].map(|c| light.of(c)))).collect();
    if is_transparent(photo) {
        let seen = |(value, texel): (&f32, &[f32; 4])| if opacity(texel) > 0.5 { Some(*value) } else { None };
        let opaque: Vec<f32> = values.iter().zip(texels).filter_map(seen).collect();
        let mean = spread(&opaque).0;
        values.par_iter_mut().zip(texels).for_each(|(v, texel)| *v = mean + (*v - mean) * opacity(texel));
    }
    Grid::new(photo.grid.width(), photo.grid.height(), values)
}

/// Returns the opacity of a texel, 0 to 1.
pub(super) fn opacity(&[.., alpha]: &[f32; 4]) -> f32 {
    alpha.max(0.0).min(1.0)
}

pub(super) fn is_transparent(photo: &ColorMap) -> bool {
    photo.grid.texels().par_iter().any(|texel| opacity(texel) < 1.0)
}

/// Returns the offset of light before its logarithm, below which light is noise: a tenth of the picture's median, so that
/// a dark exposure has the same hints as a bright one.
pub(super) fn black(photo: &ColorMap) -> f32 {
    const SAMPLES: usize = 1 << 14;
    let light = LinearDecoder::new(photo.encoding);
    let texels = photo.grid.texels();
    let of = |&[r, g, b, _]: &[f32; 4]| luminance([r, g, b].map(|c| light.of(c)));
    let some = texels.iter().step_by(texels.len().div_ceil(SAMPLES));
    let mut samples: Vec<f32> = some.filter(|texel| opacity(texel) > 0.5).map(of).collect();
    let middle = samples.len() / 2;
    if samples.is_empty() {
        return 1.0;
    }
    let median = *samples.select_nth_unstable_by(middle, f32::total_cmp).1;
    (0.1 * median).max(2e-4)
}

/// Returns the logarithm of the luminance: equal contrasts have equal differences, in light and in shadow.
pub(super) fn light(photo: &ColorMap, black: f32) -> Result<Grid<f32>, GridError> {
    each(photo, |rgb| (luminance(rgb) + black).ln())
}

/// Returns the saturation, 0 (grey) to 1.
pub(super) fn saturation(photo: &ColorMap, black: f32) -> Result<Grid<f32>, GridError> {
    each(photo, |[r, g, b]| {
        let (least, most) = (r.min(g).min(b), r.max(g).max(b));
        (most - least) / (most + black)
    })
}

/// Returns 1 where the photograph has the colour of `pick`, with a Gaussian falloff by the difference.
pub(super) fn likeness(photo: &ColorMap, pick: &ColorPick) -> Result<Grid<f32>, GridError> {
    let wanted = lab(pick.color.map(srgb_to_linear));
    let tolerance = pick.tolerance.max(0.1);
    each(photo, |rgb| {
        let [l, a, b] = lab(rgb);
        let off = (0.5 * (l - wanted[0])).powi(2) + (a - wanted[1]).powi(2) + (b - wanted[2]).powi(2);
        (-off / (tolerance * tolerance)).exp()
    })
}

/// Converts linear sRGB to CIE Lab (1976) with its white, D65.
fn lab([r, g, b]: [f32; 3]) -> [f32; 3] {
    let f = |t: f32| if t > 0.008_856 { t.cbrt() } else { 7.787 * t + 16.0 / 116.0 };
    let x = f((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505);
    let y = f(0.2126 * r + 0.7152 * g + 0.0722 * b);
    let z = f((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}
