//! FLIP: the difference that a viewer notices when two pictures alternate in place.

mod color_space;
mod filter_kernel;
mod method;
mod visual_filters;

use rayon::prelude::*;
use relievo_map::Grid;
use thiserror::Error;

use self::color_space::{ColorSpace, hyab};
use self::method::Method;
use self::visual_filters::{FilteredRow, OpponentPlanes, VisualFilters};
use super::size_mismatch::SizeMismatch;

/// Pixels per degree of visual angle at 0.7 m from a 0.7 m wide display of 3840 pixels: the paper's viewing conditions.
pub const DEFAULT_PIXELS_PER_DEGREE: f32 = 67.020_64;

/// The perceived difference between two pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct Flip {
    /// Per pixel, 0 (no difference) to 1 (the largest).
    pub map: Grid<f32>,
    /// The mean of the map.
    pub mean: f64,
}

/// An error of the computation of FLIP.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum FlipError {
    /// The pictures differ in size.
    #[error(transparent)]
    Size(#[from] SizeMismatch),
    /// The pixels per degree are out of range.
    #[error("FLIP needs 1 to 1000 pixels per degree, got {0}")]
    PixelsPerDegree(f32),
}

/// Pixels per degree of visual angle for a viewer `distance` metres from a display `width_m` metres and `width_px` pixels
/// wide.
#[must_use]
pub fn pixels_per_degree(distance: f32, width_m: f32, width_px: f32) -> f32 {
    distance * width_px / width_m * 1f32.to_radians()
}

/// Computes LDR-FLIP of two 8-bit sRGB pictures.
///
/// FLIP predicts the differences seen when flipping between the two: it blurs as the eye does at that distance, compares
/// colours, and amplifies the result where edges and points differ. The order of the pictures does not matter. Beyond the
/// border the outermost pixels are repeated. The result does not depend on the number of threads.
///
/// Pontus Andersson, Jim Nilsson, Tomas Akenine-Möller, Magnus Oskarsson, Kalle Åström, Mark D. Fairchild: *FLIP: A
/// Difference Evaluator for Alternating Images*, Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020.
///
/// # Errors
/// If the pictures differ in size, or `pixels_per_degree` is not in 1 to 1000.
pub fn flip(reference: &Grid<[u8; 3]>, test: &Grid<[u8; 3]>, pixels_per_degree: f32) -> Result<Flip, FlipError> {
    flip_with(&Method::PUBLISHED, reference, test, pixels_per_degree)
}

fn flip_with(
    method: &Method,
    reference: &Grid<[u8; 3]>,
    test: &Grid<[u8; 3]>,
    pixels_per_degree: f32,
) -> Result<Flip, FlipError> {
    SizeMismatch::check(reference, test)?;
    if !(1.0..=1000.0).contains(&pixels_per_degree) {
        return Err(FlipError::PixelsPerDegree(pixels_per_degree));
    }
    let colors = ColorSpace::new();
    let filters = VisualFilters::new(method, f64::from(pixels_per_degree));
    let scale = ColorScale::new(method, &colors);
    let pictures = [OpponentPlanes::new(reference, &colors), OpponentPlanes::new(test, &colors)];

    let width = reference.width() as usize;
    let mut map = reference.map(|_| 0.0f32);
    map.texels_mut().par_chunks_mut(width).enumerate().for_each_init(
        || [FilteredRow::new(width, &filters), FilteredRow::new(width, &filters)],
        |rows, (y, errors)| {
            for (row, picture) in rows.iter_mut().zip(&pictures) {
                row.filter(picture, y, &filters, &colors);
            }
            let [a, b] = rows;
            for (x, error) in errors.iter_mut().enumerate() {
                let color = scale.of(hyab(a.lab[x], b.lab[x]));
                let feature = (a.edge[x] - b.edge[x]).abs().max((a.point[x] - b.point[x]).abs());
                let feature = (feature * std::f32::consts::FRAC_1_SQRT_2).clamp(0.0, 1.0).powf(method.feature_exponent);
                *error = if color > 0.0 { color.powf(1.0 - feature).min(1.0) } else { 0.0 };
            }
        },
    );
    // Summed in order, so that the mean does not depend on the number of threads.
    let mean = map.texels().iter().map(|&e| f64::from(e)).sum::<f64>() / map.texels().len() as f64;
    Ok(Flip { map, mean })
}

/// Maps colour differences to 0..1, with most of that range for the small ones.
struct ColorScale {
    exponent: f32,
    bend_at: f32,
    bend_result: f32,
    largest: f32,
}

impl ColorScale {
    fn new(method: &Method, colors: &ColorSpace) -> Self {
        // The paper's largest difference between displayable colours: green to blue.
        let largest =
            hyab(colors.hunt_lab([0.0, 1.0, 0.0]), colors.hunt_lab([0.0, 0.0, 1.0])).powf(method.color_exponent);
        Self {
            exponent: method.color_exponent,
            bend_at: method.bend * largest,
            bend_result: method.bend_result,
            largest,
        }
    }

    #[inline]
    fn of(&self, distance: f32) -> f32 {
        let d = distance.powf(self.exponent);
        if d < self.bend_at {
            self.bend_result * d / self.bend_at
        } else {
            self.bend_result + (1.0 - self.bend_result) * (d - self.bend_at) / (self.largest - self.bend_at)
        }
    }
}

#[cfg(test)]
mod tests;
