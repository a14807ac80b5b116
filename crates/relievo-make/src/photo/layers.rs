//! The hints of a photograph, taken apart by scale.

use rayon::prelude::*;
use relievo_map::{ColorEncoding, ColorMap, Wrap, srgb_to_linear};

use super::{BANDS, ColorPick, Picture};
use crate::blur::gaussian;

/// Added to light before its logarithm: what is darker is noise.
const BLACK: f32 = 0.02;
/// How many standard deviations a value may be off its surroundings: specks must not outweigh everything.
const MOST: f32 = 2.0;

fn each(photo: &ColorMap, f: impl Fn([f32; 3]) -> f32 + Sync) -> Vec<f32> {
    let linear = photo.encoding == ColorEncoding::Linear;
    let light = |c: f32| if linear { c.max(0.0) } else { srgb_to_linear(c.max(0.0)) };
    photo.grid.texels().par_iter().map(|&[r, g, b, _]| f([r, g, b].map(light))).collect()
}

/// The logarithm of the luminance: the same contrast is the same, in light and in shadow.
pub(super) fn light(photo: &ColorMap) -> Vec<f32> {
    each(photo, |[r, g, b]| (0.2126 * r + 0.7152 * g + 0.0722 * b + BLACK).ln())
}

/// How far from grey: 0 to 1.
pub(super) fn saturation(photo: &ColorMap) -> Vec<f32> {
    each(photo, |[r, g, b]| {
        let (least, most) = (r.min(g).min(b), r.max(g).max(b));
        (most - least) / (most + BLACK)
    })
}

/// 1 where the photograph has the colour of `pick`, falling off as a bell with the difference.
pub(super) fn likeness(photo: &ColorMap, pick: &ColorPick) -> Vec<f32> {
    let wanted = lab(pick.color.map(srgb_to_linear));
    let tolerance = pick.tolerance.max(0.1);
    each(photo, |rgb| {
        let [l, a, b] = lab(rgb);
        let off = (0.5 * (l - wanted[0])).powi(2) + (a - wanted[1]).powi(2) + (b - wanted[2]).powi(2);
        (-off / (tolerance * tolerance)).exp()
    })
}

/// CIE Lab (1976) of linear sRGB with its white, D65.
fn lab([r, g, b]: [f32; 3]) -> [f32; 3] {
    let f = |t: f32| if t > 0.008_856 { t.cbrt() } else { 7.787 * t + 16.0 / 116.0 };
    let x = f((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505);
    let y = f(0.2126 * r + 0.7152 * g + 0.0722 * b);
    let z = f((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Values without their surroundings, in standard deviations.
pub(super) struct Layer {
    pub(super) values: Vec<f32>,
}

impl Layer {
    /// `values` without what is wider than `flatten` texels.
    pub(super) fn new(mut values: Vec<f32>, width: usize, flatten: f32, wrap: Wrap) -> Self {
        if flatten > 0.0 {
            let mut around = values.clone();
            gaussian(&mut around, width, flatten, wrap);
            values.par_iter_mut().zip(around).for_each(|(v, a)| *v -= a);
        }
        let (mean, deviation) = spread(&values);
        // A picture of one colour has no hints, only rounding.
        let scale = if deviation > 1e-4 { 1.0 / deviation } else { 0.0 };
        values.par_iter_mut().for_each(|v| *v = ((*v - mean) * scale).max(-MOST).min(MOST));
        Self { values }
    }

    /// Adds the bands to `heights`, each with its weight. What is left beyond the coarsest band has that one's weight.
    /// Returns the local contrast of the two finest bands, 1 on average.
    pub(super) fn add_bands(
        self,
        heights: &mut [f32],
        weights: &[f32; BANDS],
        picture: &Picture,
        dark_only: bool,
    ) -> Vec<f32> {
        let mut finer = self.values;
        if dark_only {
            finer.par_iter_mut().for_each(|v| *v = v.min(0.0));
        }
        let mut contrast = vec![0.0f32; finer.len()];
        for (k, &weight) in weights.iter().enumerate() {
            let mut coarser = finer.clone();
            // Each blur goes on from the one before: variances add up.
            let sigma = |k: usize| picture.texels((1u32 << k) as f32 / 1024.0);
            let step = if k == 0 { sigma(0) } else { (sigma(k).powi(2) - sigma(k - 1).powi(2)).sqrt() };
            gaussian(&mut coarser, picture.width, step, picture.wrap);
            heights.par_iter_mut().zip(&finer).zip(&coarser).for_each(|((h, f), c)| *h += weight * (f - c));
            if k < 2 {
                contrast.par_iter_mut().zip(&finer).zip(&coarser).for_each(|((o, f), c)| *o += (f - c).abs());
            }
            finer = coarser;
        }
        let rest = weights[BANDS - 1];
        heights.par_iter_mut().zip(&finer).for_each(|(h, f)| *h += rest * f);
        gaussian(&mut contrast, picture.width, picture.texels(4.0 / 1024.0), picture.wrap);
        let mean = spread(&contrast).0.max(1e-6);
        contrast.par_iter_mut().for_each(|c| *c /= mean);
        contrast
    }
}

/// Mean and standard deviation. Summed row by row in a fixed order, so that threads do not matter.
pub(super) fn spread(values: &[f32]) -> (f32, f32) {
    const RUN: usize = 1 << 14;
    let sums: Vec<[f64; 2]> = values
        .par_chunks(RUN)
        .map(|run| run.iter().fold([0.0, 0.0], |[s, q], &v| [s + f64::from(v), q + f64::from(v) * f64::from(v)]))
        .collect();
    let [sum, squares] = sums.iter().fold([0.0, 0.0], |[s, q], [a, b]| [s + a, q + b]);
    let n = values.len() as f64;
    let mean = sum / n;
    (mean as f32, (squares / n - mean * mean).max(0.0).sqrt() as f32)
}

/// The values below which these shares (in percent) of all values lie.
pub(super) fn percentiles(values: &[f32], shares: [f32; 2]) -> [f32; 2] {
    let mut sorted = values.to_vec();
    let last = sorted.len() - 1;
    shares.map(|share| {
        let k = (f64::from(share.max(0.0).min(100.0)) / 100.0 * last as f64).round() as usize;
        *sorted.select_nth_unstable_by(k, f32::total_cmp).1
    })
}

/// Smooths within `radius` texels and keeps edges that stand out by more than a tenth of the range: a guided filter (He,
/// Sun and Tang, "Guided image filtering", 2010), guided by the heights themselves, with a bell for its window.
pub(super) fn guided(heights: &mut [f32], width: usize, radius: f32, wrap: Wrap) {
    const EDGE: f32 = 0.1;
    let mut mean = heights.to_vec();
    gaussian(&mut mean, width, radius, wrap);
    let mut gain: Vec<f32> = heights.par_iter().map(|h| h * h).collect();
    gaussian(&mut gain, width, radius, wrap);
    gain.par_iter_mut().zip(&mut mean).for_each(|(g, m)| {
        let variance = (*g - *m * *m).max(0.0);
        *g = variance / (variance + EDGE * EDGE);
        *m *= 1.0 - *g;
    });
    gaussian(&mut gain, width, radius, wrap);
    gaussian(&mut mean, width, radius, wrap);
    heights.par_iter_mut().zip(gain).zip(mean).for_each(|((h, g), m)| *h = *h * g + m);
}
