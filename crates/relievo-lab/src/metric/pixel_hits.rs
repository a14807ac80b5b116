use relievo_cpu::Frame;
use relievo_map::Grid;
use relievo_scene::Scene;
use serde::Serialize;

use super::hit_error::{HitErrorSummary, length, texel_offset};
use super::percentiles::Percentiles;

/// Hit errors of a picture against the oracle's, over the pixels in which technique or oracle shows relief.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PixelHitErrors {
    /// Distance in uv over the pixels where both hit, in texels of the height map.
    pub texels: Percentiles,
    /// Fraction of pixels that are off by more than a texel, or where only one of technique and oracle hits.
    pub wrong: f64,
    /// Fraction of pixels where only one of technique and oracle hits.
    pub only_one_hits: f64,
}

/// The hits of a rendered frame, compared with those of the oracle's frame.
pub(crate) struct PixelHits {
    /// Hit error per pixel, texels; NaN where only one of the two hits, 0 where neither does.
    pub(crate) error_map: Grid<f32>,
    pub(crate) errors: PixelHitErrors,
    /// Pixels in which either frame shows relief.
    relief: Vec<(u32, u32)>,
}

impl PixelHits {
    /// Compares the hits of two frames of one size.
    pub(crate) fn new(scene: &Scene, frame: &Frame, oracle: &Frame) -> Self {
        // The size of the height map that a pixel shows; `None` where it shows no relief.
        let map_size = |frame: &Frame, x, y| {
            let material = (*frame.aovs.material.get(x, y))?;
            let height = scene.materials[material as usize].maps.height.as_ref()?;
            Some([height.grid().width() as f32, height.grid().height() as f32])
        };
        let (width, height) = (frame.pixels.width(), frame.pixels.height());
        let error_map = Grid::from_fn(width, height, |x, y| match (map_size(frame, x, y), map_size(oracle, x, y)) {
            (None, None) => 0.0,
            (Some(_), Some(size)) => length(texel_offset(*frame.aovs.uv.get(x, y), *oracle.aovs.uv.get(x, y), size)),
            _ => f32::NAN,
        });
        let shows_relief = |x: u32, y: u32| map_size(frame, x, y).is_some() || map_size(oracle, x, y).is_some();
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let relief: Vec<(u32, u32)> = pixels.filter(|&(x, y)| shows_relief(x, y)).collect();
        let errors = relief.iter().map(|&(x, y)| *error_map.get(x, y));
        let summary = HitErrorSummary::new(errors.map(|error| (!error.is_nan()).then_some(f64::from(error))));
        let errors =
            PixelHitErrors { texels: summary.texels, wrong: summary.wrong, only_one_hits: summary.only_one_hits };
        Self { error_map, errors, relief }
    }

    /// Percentiles of a map over the pixels that show relief.
    pub(crate) fn over_relief(&self, map: &Grid<f32>) -> Percentiles {
        Percentiles::of(self.relief.iter().map(|&(x, y)| *map.get(x, y)))
    }
}
