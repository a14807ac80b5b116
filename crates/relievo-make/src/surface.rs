//! Rendering of a procedural surface to the complete maps of a material.

use rayon::prelude::*;
use relievo_map::{
    Border, ColorEncoding, ColorMap, DerivativeKernel, Grid, HeightMap, MapSet, OcclusionOptions, ScalarMap,
    ambient_occlusion, height_to_normal, linear_to_srgb, srgb_to_linear,
};

use crate::error::{MAX_SIZE, MakeError};

/// Below this size features are thinner than texels: smaller maps are averaged from a finer one.
pub(crate) const FULL_DETAIL: u32 = 512;

/// A material sampled at one point.
#[derive(Clone, Copy, Default)]
pub(crate) struct Texel {
    /// 0..1, 1 = highest.
    pub(crate) height: f32,
    /// Display (sRGB) values, 0..1.
    pub(crate) color: [f32; 3],
    /// 0 mirror, 1 matt.
    pub(crate) roughness: f32,
}

/// A procedural material that is evaluated row by row: square, period 1 in u and v.
pub(crate) trait Surface: Sync {
    /// Buffers of one thread, reused from row to row.
    type Scratch;
    /// Allocates the buffers for rows of `size` texels.
    fn scratch(&self, size: usize) -> Self::Scratch;
    /// Fills the row whose texel centres lie at v and u = (x + 0.5) / length.
    fn row(&self, v: f32, scratch: &mut Self::Scratch, out: &mut [Texel]);
    /// Returns the full range of heights as a fraction of one repeat, for normals and occlusion.
    fn height_scale(&self) -> f32;
}

/// Renders the complete maps of `surface`, `size × size` texels.
pub(crate) fn render<S: Surface>(surface: &S, size: u32) -> Result<MapSet, MakeError> {
    if size == 0 || size > MAX_SIZE {
        return Err(MakeError::Size { size });
    }
    let n = size as usize;
    // Each texel is the mean of `fine × fine` samples.
    let fine = FULL_DETAIL.div_ceil(size) as usize;
    let mut height = vec![0.0f32; n * n];
    let mut color = vec![[0.0f32; 4]; n * n];
    let mut roughness = vec![0.0f32; n * n];
    height.par_chunks_mut(n).zip(color.par_chunks_mut(n)).zip(roughness.par_chunks_mut(n)).enumerate().for_each_init(
        || (surface.scratch(n * fine), vec![Texel::default(); n * fine]),
        |(scratch, samples), (y, ((height, color), roughness))| {
            let mut row = |line: usize, samples: &mut [Texel]| {
                let v = ((y * fine + line) as f32 + 0.5) / (n * fine) as f32;
                surface.row(v, scratch, samples);
            };
            if fine == 1 {
                row(0, samples);
                for (x, texel) in samples.iter().enumerate() {
                    let [r, g, b] = texel.color.map(|c| c.clamp(0.0, 1.0));
                    height[x] = texel.height.clamp(0.0, 1.0);
                    color[x] = [r, g, b, 1.0];
                    roughness[x] = texel.roughness;
                }
                return;
            }
            let weight = 1.0 / (fine * fine) as f32;
            for line in 0..fine {
                row(line, samples);
                for (x, group) in samples.chunks_exact(fine).enumerate() {
                    for texel in group {
                        height[x] += weight * texel.height.clamp(0.0, 1.0);
                        roughness[x] += weight * texel.roughness;
                        for k in 0..3 {
                            color[x][k] += weight * srgb_to_linear(texel.color[k].clamp(0.0, 1.0));
                        }
                    }
                }
            }
            for c in color {
                *c = [linear_to_srgb(c[0]), linear_to_srgb(c[1]), linear_to_srgb(c[2]), 1.0];
            }
        },
    );
    complete(size, height, color, roughness, surface.height_scale())
}

/// Completes a material of `size × size` texels: derives normals and ambient occlusion from the heights, which tile.
pub(crate) fn complete(
    size: u32,
    height: Vec<f32>,
    color: Vec<[f32; 4]>,
    roughness: Vec<f32>,
    height_scale: f32,
) -> Result<MapSet, MakeError> {
    let height = HeightMap::new(Grid::new(size, size, height)?);
    // Formulas may go beyond what a picture can show.
    let color = color.into_iter().map(|texel| texel.map(|c| c.clamp(0.0, 1.0))).collect();
    let normal = height_to_normal(&height, height_scale, DerivativeKernel::Central, Border::Wrap);
    let ao = ambient_occlusion(&height, &OcclusionOptions { height_scale, ..OcclusionOptions::default() });
    Ok(MapSet {
        base_color: Some(ColorMap { grid: Grid::new(size, size, color)?, encoding: ColorEncoding::Srgb }),
        normal: Some(normal),
        height: Some(height),
        roughness: Some(ScalarMap::new(Grid::new(size, size, roughness)?)),
        metallic: None,
        ao: Some(ao),
    })
}
