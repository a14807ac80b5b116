//! The built-in materials: two made by code, the others by recipes.

mod brick_wall;
pub(crate) mod names;
pub(crate) mod recipes;
mod toy_box;
mod wood;

use relievo_map::MapSet;

use crate::error::MakeError;
use crate::recipe::Recipe;
use crate::surface;
pub use brick_wall::BRICK_WALL_HEIGHT_SCALE;
use brick_wall::BrickWall;
pub use names::names;
pub use toy_box::TOY_BOX_HEIGHT_SCALE;
use toy_box::ToyBox;

/// A material that is made by code of its own.
struct CodedMaterial {
    name: &'static str,
    height_scale: f32,
    make: fn(u32) -> Result<MapSet, MakeError>,
}

const CODED_MATERIALS: [CodedMaterial; names::CODED.len()] = [
    CodedMaterial { name: names::CODED[0], height_scale: BRICK_WALL_HEIGHT_SCALE, make: brick_wall },
    CodedMaterial { name: names::CODED[1], height_scale: TOY_BOX_HEIGHT_SCALE, make: toy_box },
];

fn coded(name: &str) -> Option<&'static CodedMaterial> {
    CODED_MATERIALS.iter().find(|material| material.name == name)
}

/// Returns the built-in recipe called `name`. `brick-wall` and `toy-box` are made by code and have none.
///
/// # Errors
/// If no recipe has that name.
pub fn built_in(name: &str) -> Result<Recipe, MakeError> {
    let text = recipe_text(name)
        .ok_or_else(|| MakeError::UnknownName { name: name.to_owned(), nearest: names::nearest(name) })?;
    Ok(Recipe::parse(name, text, None)?)
}

/// Returns the text of the built-in recipe called `name`, if there is one: a start for your own.
#[must_use]
pub fn recipe_text(name: &str) -> Option<&'static str> {
    recipes::text(name)
}

/// Makes the material called `name`, `size × size` texels: base colour (sRGB), normal (+Y up), height, roughness and
/// ambient occlusion; never metallic. It covers one texture repeat and tiles.
///
/// # Errors
/// If no material has that name, or `size` is not 1 to [`MAX_SIZE`](crate::MAX_SIZE).
pub fn make(name: &str, size: u32) -> Result<MapSet, MakeError> {
    match coded(name) {
        Some(material) => (material.make)(size),
        None => built_in(name)?.make(size),
    }
}

/// Returns the height scale that the normals of the material `name` were made for: its full range of heights as a
/// fraction of one texture repeat.
///
/// # Errors
/// If no material has that name.
pub fn height_scale(name: &str) -> Result<f32, MakeError> {
    match coded(name) {
        Some(material) => Ok(material.height_scale),
        None => Ok(built_in(name)?.height_scale()),
    }
}

/// Makes a weathered brick wall in running bond, three bricks by eight courses to a repeat, with recessed sandy mortar.
///
/// Its height scale is [`BRICK_WALL_HEIGHT_SCALE`]. See [`make`].
///
/// # Errors
/// If `size` is not 1 to [`MAX_SIZE`](crate::MAX_SIZE).
pub fn brick_wall(size: u32) -> Result<MapSet, MakeError> {
    surface::render(&BrickWall::new(), size)
}

/// Makes a wooden box seen from above, with a painted hemisphere, pyramid, frustum and torus on its floor.
///
/// Its height scale is [`TOY_BOX_HEIGHT_SCALE`]; the rim at the border is high all round. See [`make`].
///
/// # Errors
/// If `size` is not 1 to [`MAX_SIZE`](crate::MAX_SIZE).
pub fn toy_box(size: u32) -> Result<MapSet, MakeError> {
    surface::render(&ToyBox::new(), size)
}
