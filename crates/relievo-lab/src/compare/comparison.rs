use relievo_map::Grid;

use crate::metric::{Flip, Percentiles, PixelHitErrors};
use crate::technique::TechniqueSpec;

/// One technique of a comparison.
#[derive(Clone, Debug)]
pub struct ComparisonEntry {
    /// The technique.
    pub technique: TechniqueSpec,
    /// Its picture.
    pub picture: Grid<[u8; 3]>,
    /// FLIP against the picture of displaced geometry.
    pub flip: Flip,
    /// PSNR against the same, dB; infinite where equal.
    pub psnr: f64,
    /// Hit errors against the true surface.
    pub hits: PixelHitErrors,
    /// Distance of each pixel's hit from the true one, texels; NaN where only one of the two hits, 0 where neither does.
    pub hit_error_map: Grid<f32>,
    /// Height look-ups of each pixel.
    pub fetch_map: Grid<f32>,
    /// Height look-ups over the relief's pixels.
    pub fetches: Percentiles,
    /// Loop iterations over the relief's pixels.
    pub iterations: Percentiles,
    /// Time to draw, milliseconds.
    pub frame_ms: f64,
    /// Time to prepare the scene (mip levels, displaced grid, BVH), milliseconds.
    pub build_ms: f64,
    /// Triangles in the scene.
    pub triangles: usize,
}

/// Techniques side by side.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// The picture of displaced geometry, as seen through the polygons (see [`compare`](crate::compare)).
    pub truth: Grid<[u8; 3]>,
    /// Vertices per side of the truth's grids, one per material with a relief.
    pub truth_grids: Vec<u32>,
    /// Vertices along a texel of the truth's picture where they stand farthest apart, one per material with a relief.
    pub truth_per_texel: Vec<f64>,
    /// Sentences on where the truth is too coarse to judge by; empty where it is not.
    pub truth_notes: Vec<String>,
    /// Triangles of the truth.
    pub truth_triangles: usize,
    /// Time to draw the truth, milliseconds.
    pub truth_frame_ms: f64,
    /// Time to build the truth, milliseconds.
    pub truth_build_ms: f64,
    /// The techniques, in the order of the options.
    pub entries: Vec<ComparisonEntry>,
}
