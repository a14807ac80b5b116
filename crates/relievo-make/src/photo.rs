//! Heights from the light and dark of a photograph.
//!
//! A photograph does not hold heights. What it holds are hints: joints and cracks are dark, stones are more coloured than
//! mortar, slopes towards the light are bright. [`from_photo`] takes such hints apart by scale, weighs each with a sign,
//! and puts them together again; presets have weights for common materials.
//!
//! ```text
//!  colour ─▶ linear light ─▶ logarithm − its surroundings ─▶ bands × weights ──┐
//!                         └▶ saturation − its surroundings ─▶ bands × weights ─┤
//!                         └▶ shading ─▶ slopes ─▶ Poisson ─────────────────────┴─▶ Σ ─▶ colour picks ─▶ smoothing that keeps
//!                                                                          edges ─▶ levels ─▶ height, normal, AO, roughness
//! ```

mod layers;
mod preset;

use rayon::prelude::*;
use relievo_map::{
    Border, ColorMap, DerivativeKernel, Grid, GridError, HeightMap, IntegrateOptions, MapSet, NormalMap,
    OcclusionOptions, ScalarMap, Wrap, ambient_occlusion, height_to_normal, normal_to_height, periodic,
};
use thiserror::Error;

use crate::blur::gaussian;
use crate::curve::smoothstep;
use crate::edit::add_resized;
use layers::{add_bands, flattened, percentiles, spread};
pub use preset::PhotoPreset;

/// Bands from fine to coarse: the first holds what a blur of 1/1024 of the picture's width takes away, each other one what
/// the next blur, twice as wide, takes away beyond that.
pub const BANDS: usize = 7;

/// A colour of the photograph, all of which lies higher or lower than the rest: mortar, paint, moss.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorPick {
    /// Display (sRGB) colour, 0..1.
    pub color: [f32; 3],
    /// By how much of the range of heights it is raised; negative lowers it.
    pub offset: f32,
    /// How different a colour may be, in units of CIE Lab (1: hardly seen, 10: akin, 100: black to white). Lightness
    /// counts half.
    pub tolerance: f32,
}

/// Light that came from one side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SideLight {
    /// Where it came from, in degrees: 0 right, 90 above, 180 left, 270 below.
    pub angle: f32,
    /// The weight of what the shading tells, as a standard deviation: 1 as much as a band of weight 1.
    pub weight: f32,
}

/// What lies beyond the photograph's border.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PhotoEdge {
    /// It ends there.
    #[default]
    Open,
    /// It tiles as it is.
    Tiles,
    /// It is made to tile: the jumps at the border are spread smoothly over all of it.
    MakeTile,
}

/// How heights are made of a photograph.
#[derive(Clone, Debug, PartialEq)]
pub struct PhotoOptions {
    /// Light changes that are wider than this (standard deviation, as a fraction of the width) are taken as uneven
    /// lighting and removed; 0 keeps them.
    pub flatten: f32,
    /// Weights of the bands of light, fine to coarse: positive where dark is deep.
    pub light: [f32; BANDS],
    /// Weights of the bands of saturation: positive where grey is deep, as mortar between bricks.
    pub saturation: [f32; BANDS],
    /// Only what is darker than its surroundings counts: cracks on a plain.
    pub dark_only: bool,
    /// Shading to slopes to heights.
    pub side_light: Option<SideLight>,
    /// Colours that lie higher or lower.
    pub picks: Vec<ColorPick>,
    /// Where it is 0, the height is plain; of the photograph's size.
    pub mask: Option<ScalarMap>,
    /// Radius of the smoothing that keeps edges, as a fraction of the width; 0 leaves the heights as they are.
    pub clean: f32,
    /// The shares of texels, in percent, that become 0 and 1.
    pub levels: [f32; 2],
    /// What lies beyond the border.
    pub edge: PhotoEdge,
    /// The full range of heights as a fraction of one repeat, for normals and ambient occlusion.
    pub height_scale: f32,
    /// The mean roughness.
    pub roughness: f32,
}

/// Standard deviations of the saturation below which a picture counts as grey, and above which its colours are trusted.
const GREY: f32 = 0.015;
const COLORED: f32 = 0.05;

/// Why no heights could be made of a photograph.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum PhotoError {
    /// The mask has another size.
    #[error(
        "the mask has {}×{} texels and the photograph {}×{}; give a mask of the same size",
        mask[0], mask[1], photo[0], photo[1]
    )]
    MaskSize {
        /// Width and height.
        mask: [u32; 2],
        /// Width and height.
        photo: [u32; 2],
    },
    /// The mask is 0 everywhere.
    #[error("the mask is black everywhere, so that nothing of the photograph would be used; paint white what counts")]
    EmptyMask,
    /// A map cannot have this size.
    #[error(transparent)]
    Grid(#[from] GridError),
}

/// What [`from_photo`] makes. Normals and occlusion come from the heights when they are asked for: so all of it need never be
/// in memory at once.
#[derive(Clone, Debug, PartialEq)]
pub struct PhotoMaps {
    /// The photograph; made to tile, if that was asked for.
    pub color: ColorMap,
    /// Its heights.
    pub height: HeightMap,
    /// Roughness: more where fine light and dark differ much, and where it lies deep.
    pub roughness: ScalarMap,
}

impl PhotoMaps {
    /// All maps of the material: these, normals (+Y up) and ambient occlusion.
    #[must_use]
    pub fn into_maps(self, options: &PhotoOptions) -> MapSet {
        MapSet {
            normal: Some(options.normal(&self.height)),
            ao: Some(options.ao(&self.height)),
            base_color: Some(self.color),
            height: Some(self.height),
            roughness: Some(self.roughness),
            metallic: None,
        }
    }
}

/// Height and roughness made of a photograph, which goes through.
///
/// Same photograph and options, same bytes, on any number of threads. A photograph of one colour gives flat maps; where it is
/// transparent, heights are plain. The most memory that is held beside the photograph is that of its four channels again,
/// and more if it has side light, a mask, or is made to tile.
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
    let (mut heights, contrast) = hints(&photo, options)?;
    normalise(&mut heights, options.levels);
    for pick in &options.picks {
        raise(&mut heights, &photo, pick, wrap)?;
    }
    if !options.picks.is_empty() {
        normalise(&mut heights, options.levels);
    }
    if options.clean > 0.0 {
        layers::guided(&mut heights, options.clean, wrap);
    }
    if let Some(mask) = &options.mask {
        keep_plain(&mut heights, mask.grid().texels().par_iter().copied());
    }
    if layers::is_transparent(&photo) {
        keep_plain(&mut heights, photo.grid.texels().par_iter().map(layers::opacity));
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

impl PhotoOptions {
    /// Normals (+Y up) of heights that were made with these options.
    #[must_use]
    pub fn normal(&self, height: &HeightMap) -> NormalMap {
        height_to_normal(height, self.height_scale, DerivativeKernel::Central, self.border())
    }

    /// Ambient occlusion of heights that were made with these options.
    #[must_use]
    pub fn ao(&self, height: &HeightMap) -> ScalarMap {
        let (height_scale, border) = (self.height_scale, self.border());
        ambient_occlusion(height, &OcclusionOptions { height_scale, border, ..OcclusionOptions::default() })
    }

    fn wrap(&self) -> Wrap {
        if self.edge == PhotoEdge::Open { Wrap::Mirror } else { Wrap::Repeat }
    }

    fn border(&self) -> Border {
        if self.edge == PhotoEdge::Open { Border::Open } else { Border::Wrap }
    }
}

fn check_mask(mask: Option<&ScalarMap>, photo: [u32; 2]) -> Result<(), PhotoError> {
    let Some(mask) = mask else { return Ok(()) };
    let size = [mask.grid().width(), mask.grid().height()];
    if size != photo {
        return Err(PhotoError::MaskSize { mask: size, photo });
    }
    if mask.grid().texels().iter().all(|&m| m <= 0.0) { Err(PhotoError::EmptyMask) } else { Ok(()) }
}

/// Takes the jumps across the seam out of each channel.
fn make_tile(grid: &mut Grid<[f32; 4]>) {
    for k in 0..3 {
        let channel = periodic(&grid.map(|c| c[k]));
        grid.texels_mut().par_iter_mut().zip(channel.texels()).for_each(|(t, c)| t[k] = c.max(0.0));
    }
}

/// The weighted sum of all hints, and the local contrast of the finest ones, with fewer texels.
fn hints(photo: &ColorMap, options: &PhotoOptions) -> Result<(Grid<f32>, Grid<f32>), PhotoError> {
    let wrap = options.wrap();
    let black = layers::black(photo);
    let mut heights = Grid::filled(photo.grid.width(), photo.grid.height(), 0.0);
    let (mut light, _) = flattened(layers::light(photo, black)?, options.flatten, wrap);
    let mut weights = options.light;
    if options.saturation.iter().any(|w| *w != 0.0) {
        let (saturation, deviation) = flattened(layers::saturation(photo, black)?, options.flatten, wrap);
        let trust = smoothstep(GREY, COLORED, deviation);
        heights = add_bands(heights, saturation, &options.saturation.map(|w| w * trust), wrap);
        if trust < 1.0 {
            // Colour tells nothing here but noise: the light must tell what it was to tell. Joints are the lesser part of a
            // wall: where that is bright, bright is deep.
            let sign = 1.0 - 2.0 * smoothstep(0.2, 0.7, layers::skewness(&light, wrap));
            weights.iter_mut().zip(&options.saturation).for_each(|(w, color)| *w += (1.0 - trust) * sign * color);
        }
    }
    let contrast = layers::contrast(&light, wrap);
    if let Some(side) = &options.side_light {
        layers::add(&mut heights, &shading(&light, side, options.border()), 1.0);
    }
    if options.dark_only {
        light.texels_mut().par_iter_mut().for_each(|v| *v = v.min(0.0));
    }
    Ok((add_bands(heights, light, &weights, wrap), contrast))
}

/// Heights whose slopes towards the light are as bright as `light` (Pentland, "Linear shape from shading", 1990):
/// what is bright falls towards the light. Slopes across the light are not seen, and are taken as none.
fn shading(light: &Grid<f32>, side: &SideLight, border: Border) -> Grid<f32> {
    let (sin, cos) = side.angle.to_radians().sin_cos();
    // A standard deviation of brightness as a slope of 0.3: gentle, so that the normals' lengths hardly matter.
    let normals = NormalMap::new(light.map(|l| unit([0.3 * l * cos, 0.3 * l * sin, 1.0])));
    let options = IntegrateOptions { kernel: DerivativeKernel::Central, border, damping: Some(1e-3) };
    let mut found = normal_to_height(&normals, &options).map.into_grid();
    let (mean, deviation) = spread(found.texels());
    let scale = side.weight / deviation.max(1e-6);
    found.texels_mut().par_iter_mut().for_each(|h| *h = (*h - mean) * scale);
    found
}

fn unit(n: [f32; 3]) -> [f32; 3] {
    let length = n.iter().map(|c| c * c).sum::<f32>().sqrt();
    n.map(|c| c / length)
}

/// Stretches the levels to 0 and 1; what is all the same becomes ½.
fn normalise(heights: &mut Grid<f32>, levels: [f32; 2]) {
    let [low, high] = percentiles(heights.texels(), levels);
    let scale = if high > low { 1.0 / (high - low) } else { 0.0 };
    let flat = if high > low { 0.0 } else { 0.5 };
    heights.texels_mut().par_iter_mut().for_each(|h| *h = ((*h - low) * scale + flat).max(0.0).min(1.0));
}

/// Raises what has the colour of `pick`.
fn raise(heights: &mut Grid<f32>, photo: &ColorMap, pick: &ColorPick, wrap: Wrap) -> Result<(), PhotoError> {
    let mut near = layers::likeness(photo, pick)?;
    let width = near.width() as usize;
    gaussian(near.texels_mut(), width, width as f32 * 2.0 / 1024.0, wrap);
    heights.texels_mut().par_iter_mut().zip(near.texels()).for_each(|(h, m)| *h += pick.offset * m);
    Ok(())
}

/// Where `share` is 0, the height becomes the usual one.
fn keep_plain(heights: &mut Grid<f32>, share: impl IndexedParallelIterator<Item = f32>) {
    let plain = percentiles(heights.texels(), [50.0, 50.0])[0];
    heights.texels_mut().par_iter_mut().zip(share).for_each(|(h, share)| *h = plain + (*h - plain) * share);
}
