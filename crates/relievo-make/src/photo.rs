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
    Border, ColorMap, Grid, GridError, HeightMap, IntegrateOptions, Kernel, MapSet, NormalMap, OcclusionOptions,
    ScalarMap, Wrap, ambient_occlusion, height_to_normal, normal_to_height, periodic,
};
use thiserror::Error;

use crate::blur::gaussian;
use layers::{Layer, guided, percentiles, spread};
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

/// The material of a photograph: its colour, and height, normal (+Y up), ambient occlusion and roughness made of it.
///
/// Same photograph and options, same bytes, on any number of threads. A photograph of one colour gives flat maps.
///
/// # Errors
/// If the mask does not fit or is empty.
pub fn from_photo(photo: &ColorMap, options: &PhotoOptions) -> Result<MapSet, PhotoError> {
    let (width, height) = (photo.grid.width(), photo.grid.height());
    check_mask(options.mask.as_ref(), [width, height])?;
    let mut photo = photo.clone();
    if options.edge == PhotoEdge::MakeTile {
        photo.grid = tiled(&photo.grid)?;
    }
    let scene = Picture { width: width as usize, wrap: options.wrap(), border: options.border() };
    let (mut heights, contrast) = hints(&photo, options, &scene)?;
    normalise(&mut heights, options.levels);
    for pick in &options.picks {
        raise(&mut heights, &photo, pick, &scene);
    }
    if !options.picks.is_empty() {
        normalise(&mut heights, options.levels);
    }
    if options.clean > 0.0 {
        guided(&mut heights, scene.width, options.clean * width as f32, scene.wrap);
    }
    if let Some(mask) = &options.mask {
        let plain = percentiles(&heights, [50.0, 50.0])[0];
        heights.par_iter_mut().zip(mask.grid().texels()).for_each(|(h, m)| *h = plain + (*h - plain) * m);
    }
    let mut grid = Grid::new(width, height, heights)?;
    if options.edge == PhotoEdge::MakeTile {
        // Bands and picks hardly bring jumps back, but nothing less than none will do.
        grid = periodic(&grid);
    }
    complete(photo, HeightMap::new(grid), &contrast, options)
}

/// Where the picture ends and how.
struct Picture {
    width: usize,
    wrap: Wrap,
    border: Border,
}

impl Picture {
    /// A fraction of the width in texels.
    fn texels(&self, fraction: f32) -> f32 {
        fraction * self.width as f32
    }
}

impl PhotoOptions {
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

/// Each channel without jumps across the seam.
fn tiled(grid: &Grid<[f32; 4]>) -> Result<Grid<[f32; 4]>, GridError> {
    let mut texels = grid.texels().to_vec();
    for k in 0..3 {
        let channel = periodic(&grid.map(|c| c[k]));
        texels.par_iter_mut().zip(channel.texels()).for_each(|(t, c)| t[k] = c.max(0.0));
    }
    Grid::new(grid.width(), grid.height(), texels)
}

/// The weighted sum of all hints, and the local contrast of the finest ones.
fn hints(photo: &ColorMap, options: &PhotoOptions, picture: &Picture) -> Result<(Vec<f32>, Vec<f32>), PhotoError> {
    let flatten = picture.texels(options.flatten);
    let light = layers::light(photo);
    let light = Layer::new(light, picture.width, flatten, picture.wrap);
    let mut heights = vec![0.0f32; light.values.len()];
    if let Some(side) = &options.side_light {
        shading(&mut heights, &light.values, side, picture, photo.grid.height())?;
    }
    let contrast = light.add_bands(&mut heights, &options.light, picture, options.dark_only);
    if options.saturation.iter().any(|w| *w != 0.0) {
        let saturation = Layer::new(layers::saturation(photo), picture.width, flatten, picture.wrap);
        saturation.add_bands(&mut heights, &options.saturation, picture, false);
    }
    Ok((heights, contrast))
}

/// Adds heights whose slopes towards the light are as bright as `light` (Pentland, "Linear shape from shading", 1990):
/// what is bright falls towards the light. Slopes across the light are not seen, and are taken as none.
fn shading(
    heights: &mut [f32],
    light: &[f32],
    side: &SideLight,
    picture: &Picture,
    rows: u32,
) -> Result<(), PhotoError> {
    let (sin, cos) = side.angle.to_radians().sin_cos();
    // A standard deviation of brightness as a slope of 0.3: gentle, so that the normals' lengths hardly matter.
    let normals = light.par_iter().map(|l| [0.3 * l * cos, 0.3 * l * sin, 1.0]).map(unit).collect();
    let normals = NormalMap::new(Grid::new(picture.width as u32, rows, normals)?);
    let options = IntegrateOptions { kernel: Kernel::Central, border: picture.border, damping: Some(1e-3) };
    let mut found = normal_to_height(&normals, &options).map.into_grid().into_texels();
    let (mean, deviation) = spread(&found);
    let scale = side.weight / deviation.max(1e-6);
    found.par_iter_mut().for_each(|h| *h = (*h - mean) * scale);
    heights.par_iter_mut().zip(found).for_each(|(h, f)| *h += f);
    Ok(())
}

fn unit(n: [f32; 3]) -> [f32; 3] {
    let length = n.iter().map(|c| c * c).sum::<f32>().sqrt();
    n.map(|c| c / length)
}

/// Stretches the levels to 0 and 1; what is all the same becomes ½.
fn normalise(heights: &mut [f32], levels: [f32; 2]) {
    let [low, high] = percentiles(heights, levels);
    let scale = if high > low { 1.0 / (high - low) } else { 0.0 };
    let flat = if high > low { 0.0 } else { 0.5 };
    heights.par_iter_mut().for_each(|h| *h = ((*h - low) * scale + flat).max(0.0).min(1.0));
}

/// Raises what has the colour of `pick`.
fn raise(heights: &mut [f32], photo: &ColorMap, pick: &ColorPick, picture: &Picture) {
    let mut near = layers::likeness(photo, pick);
    gaussian(&mut near, picture.width, picture.texels(2.0 / 1024.0), picture.wrap);
    heights.par_iter_mut().zip(near).for_each(|(h, m)| *h += pick.offset * m);
}

fn complete(
    photo: ColorMap,
    height: HeightMap,
    contrast: &[f32],
    options: &PhotoOptions,
) -> Result<MapSet, PhotoError> {
    let (width, rows) = (height.grid().width(), height.grid().height());
    let scale = options.height_scale;
    let normal = height_to_normal(&height, scale, Kernel::Central, options.border());
    let occlusion = OcclusionOptions { height_scale: scale, border: options.border(), ..OcclusionOptions::default() };
    let ao = ambient_occlusion(&height, &occlusion);
    // Where fine light and dark differ much the surface is rough; what lies deep gathers dust.
    let rough = |(contrast, height): (&f32, &f32)| options.roughness + 0.12 * (contrast - 1.0) + 0.1 * (0.5 - height);
    let roughness = contrast.par_iter().zip(height.grid().texels()).map(rough).collect();
    let roughness = ScalarMap::new(Grid::new(width, rows, roughness)?);
    Ok(MapSet {
        base_color: Some(photo),
        normal: Some(normal),
        height: Some(height),
        roughness: Some(roughness),
        metallic: None,
        ao: Some(ao),
    })
}
