//! Height and roughness of a photograph: the hints weighted, summed, cleaned and brought to the full range.

use rayon::prelude::*;
use relievo_map::{
    Border, ColorMap, DerivativeKernel, Grid, HeightMap, IntegrateOptions, NormalMap, ScalarMap, Wrap,
    normal_to_height, periodic,
};

use super::bands::{self, add_bands, flattened};
use super::error::PhotoError;
use super::hints;
use super::maps::PhotoMaps;
use super::options::{ColorPick, PhotoEdge, PhotoOptions, SideLight};
use super::statistics::{percentiles, spread};
use crate::blur::gaussian;
use crate::curve::smoothstep;
use crate::edit::add_resized;

/// Standard deviation of the saturation below which a picture counts as grey.
const GREY: f32 = 0.015;
/// Standard deviation of the saturation above which the colours are trusted.
const COLORED: f32 = 0.05;

/// Makes height and roughness of a photograph, which is passed through.
///
/// Deterministic: the same photograph and options give the same bytes on any number of threads. A photograph of one colour
/// gives flat maps; where it is transparent, heights are plain. Beside the photograph this holds the memory of four
/// channels, and more with side light, a mask, or an edge that is made to tile.
///
/// # Errors
/// If the mask does not fit or is empty.
pub fn from_photo(photo: ColorMap, options: &PhotoOptions) -> Result<PhotoMaps, PhotoError> {
    let (width, height) = (photo.grid.width(), photo.grid.height());
    check_mask(options.mask.as_ref(), [width, height])?;
    let mut photo = photo;
    let wrap = options.wrap();
    if options.edge == PhotoEdge::MakeTile {
        make_tile(&mut photo.grid);
    }
    let (mut heights, contrast) = weighted_hints(&photo, options)?;
    normalise(&mut heights, options.levels);
    for pick in &options.picks {
        raise(&mut heights, &photo, pick, wrap)?;
    }
    if !options.picks.is_empty() {
        normalise(&mut heights, options.levels);
    }
    if options.clean > 0.0 {
        bands::guided(&mut heights, options.clean, wrap);
    }
    if let Some(mask) = &options.mask {
        keep_plain(&mut heights, mask.grid().texels().par_iter().copied());
    }
    if hints::is_transparent(&photo) {
        keep_plain(&mut heights, photo.grid.texels().par_iter().map(hints::opacity));
    }
    if options.edge == PhotoEdge::MakeTile {
        // Bands and picks hardly bring jumps back, but nothing less than none will do.
        heights = periodic(&heights);
    }
    let height = HeightMap::new(heights);
    // Where fine light and dark differ much the surface is rough; what lies deep gathers dust.
    let mut rough = height.grid().map(|h| options.roughness - 0.12 + 0.1 * (0.5 - h));
    add_resized(&mut rough, &contrast, 0.12, wrap);
    Ok(PhotoMaps { color: photo, height, roughness: ScalarMap::new(rough) })
}

fn check_mask(mask: Option<&ScalarMap>, photo: [u32; 2]) -> Result<(), PhotoError> {
    let Some(mask) = mask else { return Ok(()) };
    let size = [mask.grid().width(), mask.grid().height()];
    if size != photo {
        return Err(PhotoError::MaskSize { mask: size, photo });
    }
    if mask.grid().texels().iter().all(|&m| m <= 0.0) { Err(PhotoError::EmptyMask) } else { Ok(()) }
}

/// Removes the jumps across the seam from each channel.
fn make_tile(grid: &mut Grid<[f32; 4]>) {
    for k in 0..3 {
        let channel = periodic(&grid.map(|c| c[k]));
        grid.texels_mut().par_iter_mut().zip(channel.texels()).for_each(|(t, c)| t[k] = c.max(0.0));
    }
}

/// Returns the weighted sum of all hints, and the local contrast of the finest ones, with fewer texels.
fn weighted_hints(photo: &ColorMap, options: &PhotoOptions) -> Result<(Grid<f32>, Grid<f32>), PhotoError> {
    let wrap = options.wrap();
    let black = hints::black(photo);
    let mut heights = Grid::filled(photo.grid.width(), photo.grid.height(), 0.0);
    let (mut light, _) = flattened(hints::light(photo, black)?, options.flatten, wrap);
    let mut weights = options.light;
    if options.saturation.iter().any(|w| *w != 0.0) {
        let (saturation, deviation) = flattened(hints::saturation(photo, black)?, options.flatten, wrap);
        let trust = smoothstep(GREY, COLORED, deviation);
        heights = add_bands(heights, saturation, &options.saturation.map(|w| w * trust), wrap);
        if trust < 1.0 {
            // Colour tells nothing here but noise: the light must tell what it was to tell. Joints are the lesser part of a
            // wall: where that is bright, bright is deep.
            let sign = 1.0 - 2.0 * smoothstep(0.2, 0.7, bands::skewness(&light, wrap));
            weights.iter_mut().zip(&options.saturation).for_each(|(w, color)| *w += (1.0 - trust) * sign * color);
        }
    }
    let contrast = bands::contrast(&light, wrap);
    if let Some(side) = &options.side_light {
        bands::add(&mut heights, &shading(&light, side, options.border()), 1.0);
    }
    if options.dark_only {
        light.texels_mut().par_iter_mut().for_each(|v| *v = v.min(0.0));
    }
    Ok((add_bands(heights, light, &weights, wrap), contrast))
}

/// Integrates shading to heights (Pentland, "Linear shape from shading", 1990): bright texels slope towards the light. Slopes
/// across the light are invisible, and count as none.
fn shading(light: &Grid<f32>, side: &SideLight, border: Border) -> Grid<f32> {
    let (sin, cos) = side.angle.to_radians().sin_cos();
    // A standard deviation of brightness as a slope of 0.3: gentle, so that the normals' lengths hardly matter.
    let normals = NormalMap::new(light.map(|l| normalized([0.3 * l * cos, 0.3 * l * sin, 1.0])));
    let options = IntegrateOptions { kernel: DerivativeKernel::Central, border, damping: Some(1e-3) };
    let mut found = normal_to_height(&normals, &options).map.into_grid();
    let (mean, deviation) = spread(found.texels());
    let scale = side.weight / deviation.max(1e-6);
    found.texels_mut().par_iter_mut().for_each(|h| *h = (*h - mean) * scale);
    found
}

fn normalized(n: [f32; 3]) -> [f32; 3] {
    let length = n.iter().map(|c| c * c).sum::<f32>().sqrt();
    n.map(|c| c / length)
}

/// Stretches the levels to 0 and 1; a constant map becomes ½.
fn normalise(heights: &mut Grid<f32>, levels: [f32; 2]) {
    let [low, high] = percentiles(heights.texels(), levels);
    let scale = if high > low { 1.0 / (high - low) } else { 0.0 };
    let flat = if high > low { 0.0 } else { 0.5 };
    heights.texels_mut().par_iter_mut().for_each(|h| *h = ((*h - low) * scale + flat).max(0.0).min(1.0));
}

/// Raises the texels of the picked colour.
fn raise(heights: &mut Grid<f32>, photo: &ColorMap, pick: &ColorPick, wrap: Wrap) -> Result<(), PhotoError> {
    let mut near = hints::likeness(photo, pick)?;
    let width = near.width() as usize;
    gaussian(near.texels_mut(), width, width as f32 * 2.0 / 1024.0, wrap);
    heights.texels_mut().par_iter_mut().zip(near.texels()).for_each(|(h, m)| *h += pick.offset * m);
    Ok(())
}

/// Interpolates from the median height (`share` 0) to the height itself (1).
fn keep_plain(heights: &mut Grid<f32>, share: impl IndexedParallelIterator<Item = f32>) {
    let plain = percentiles(heights.texels(), [50.0, 50.0])[0];
    heights.texels_mut().par_iter_mut().zip(share).for_each(|(h, share)| *h = plain + (*h - plain) * share);
}
