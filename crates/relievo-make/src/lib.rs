//! Maps made from nothing: complete procedural materials and the analytic shapes that tests need.
//!
//! ```text
//!  name ──make──▶ surface (height, colour, roughness at u, v) ──▶ rows of texels ──▶ height ──▶ normal, ambient occlusion
//!    └──▶ recipe (TOML: steps) ──▶ step by step ─────────────────────────┘           └────────────┴──▶ MapSet
//! ```
//!
//! A [`recipe`] is a graph of steps in a TOML file; the built-in ones are such files. [`noise`](Noise), [`Voronoi`] cells,
//! [`Masonry`] and [`sdf`] are what its steps are made of.
//!
//! Materials are designed in uv space: a larger map shows the same wall in more detail, a smaller one is its average. They
//! tile exactly, need no files, and come out the same, byte for byte, on any number of threads.
//!
//! ```
//! let wall = relievo_make::make("brick-wall", 64)?;
//! assert_eq!(wall.height.unwrap().grid().width(), 64);
//! # Ok::<(), relievo_make::MakeError>(())
//! ```

mod basis;
mod blur;
mod bricks;
mod builtin;
mod curve;
pub mod edit;
mod erosion;
mod field;
mod formula;
mod fractal;
mod masonry;
mod noise;
pub mod paint;
pub mod photo;
pub mod recipe;
pub mod sdf;
pub mod shapes;
mod surface;
mod toy_box;
mod voronoi;
mod wood;

pub use basis::{Basis, Noise};
pub use bricks::BRICK_WALL_HEIGHT_SCALE;
pub use fractal::{Fractal, FractalKind};
pub use masonry::{Bond, BrickPoint, Masonry};
pub use photo::{ColorPick, PhotoEdge, PhotoError, PhotoMaps, PhotoOptions, PhotoPreset, SideLight, from_photo};
pub use recipe::{Recipe, RecipeError};
pub use voronoi::{CellPoint, Voronoi};

use relievo_map::{GridError, MapSet};
use thiserror::Error;
pub use toy_box::TOY_BOX_HEIGHT_SCALE;

/// The largest material that can be made, in texels per side. Every texel takes 40 bytes of memory in
/// all, so the largest takes 10 GiB.
pub const MAX_SIZE: u32 = 1 << 14;

/// Why a material could not be made.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum MakeError {
    /// No material has this name.
    #[error("no generated material is called \"{name}\"{}. There are: {}", hint(*nearest), names().join(", "))]
    UnknownName {
        /// What was asked for.
        name: String,
        /// The known name that looks most like it, if one does.
        nearest: Option<&'static str>,
    },
    /// The size is 0 or over [`MAX_SIZE`].
    #[error("a generated material of {size}×{size} texels cannot be made: the size must be 1 to {MAX_SIZE}")]
    Size {
        /// Texels per side.
        size: u32,
    },
    /// A recipe cannot be followed.
    #[error(transparent)]
    Recipe(#[from] RecipeError),
    /// The maps do not fit the limits of a grid.
    #[error(transparent)]
    Grid(#[from] GridError),
}

fn hint(nearest: Option<&str>) -> String {
    nearest.map(|name| format!(" (did you mean \"{name}\"?)")).unwrap_or_default()
}

/// A material that is made by code of its own: its name, recommended height scale and maker.
struct Material {
    name: &'static str,
    height_scale: f32,
    make: fn(u32) -> Result<MapSet, MakeError>,
}

const MATERIALS: [Material; 2] = [
    Material { name: "brick-wall", height_scale: BRICK_WALL_HEIGHT_SCALE, make: brick_wall },
    Material { name: "toy-box", height_scale: TOY_BOX_HEIGHT_SCALE, make: toy_box },
];

const NAMES: [&str; MATERIALS.len() + builtin::RECIPES.len()] = {
    let mut names = [""; MATERIALS.len() + builtin::RECIPES.len()];
    let mut k = 0;
    while k < names.len() {
        names[k] = if k < MATERIALS.len() { MATERIALS[k].name } else { builtin::RECIPES[k - MATERIALS.len()].0 };
        k += 1;
    }
    names
};

/// The names of all generated materials, as [`make`] takes them.
#[must_use]
pub fn names() -> &'static [&'static str] {
    &NAMES
}

/// The built-in recipe called `name`, if there is one: `brick-wall` and `toy-box` are not made by recipes.
///
/// # Errors
/// If no recipe has that name.
pub fn built_in(name: &str) -> Result<Recipe, MakeError> {
    let text = builtin::text(name).ok_or_else(|| unknown(name))?;
    Ok(Recipe::parse(name, text, None)?)
}

/// The text of the built-in recipe called `name`, if there is one: a start for your own.
#[must_use]
pub fn recipe_text(name: &str) -> Option<&'static str> {
    builtin::text(name)
}

fn unknown(name: &str) -> MakeError {
    let nearest = NAMES
        .into_iter()
        .map(|known| (strsim::jaro_winkler(known, &name.to_lowercase()), known))
        .filter(|&(likeness, _)| likeness > 0.7)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, known)| known);
    MakeError::UnknownName { name: name.to_owned(), nearest }
}

/// The generated material called `name`, `size × size` texels: base colour (sRGB), normal (+Y up), height, roughness and
/// ambient occlusion; never metallic. It covers one texture repeat and tiles.
///
/// # Errors
/// If no material has that name, or `size` is not 1 to [`MAX_SIZE`].
pub fn make(name: &str, size: u32) -> Result<MapSet, MakeError> {
    match MATERIALS.iter().find(|m| m.name == name) {
        Some(material) => (material.make)(size),
        None => built_in(name)?.make(size),
    }
}

/// The height scale that the normals of the material `name` were made for: its full range of heights as a fraction of
/// one texture repeat.
///
/// # Errors
/// If no material has that name.
pub fn height_scale(name: &str) -> Result<f32, MakeError> {
    match MATERIALS.iter().find(|m| m.name == name) {
        Some(material) => Ok(material.height_scale),
        None => Ok(built_in(name)?.height_scale()),
    }
}

/// A weathered brick wall in running bond, three bricks by eight courses to a repeat, with recessed sandy mortar.
///
/// Its height scale is [`BRICK_WALL_HEIGHT_SCALE`]. See [`make`].
///
/// # Errors
/// If `size` is not 1 to [`MAX_SIZE`].
pub fn brick_wall(size: u32) -> Result<MapSet, MakeError> {
    surface::render(&bricks::BrickWall::new(), size)
}

/// A wooden box seen from above, with a painted hemisphere, pyramid, frustum and torus on its floor.
///
/// Its height scale is [`TOY_BOX_HEIGHT_SCALE`]; the rim at the border is high all round. See [`make`].
///
/// # Errors
/// If `size` is not 1 to [`MAX_SIZE`].
pub fn toy_box(size: u32) -> Result<MapSet, MakeError> {
    surface::render(&toy_box::ToyBox::new(), size)
}
