//! A picture of a material for sheets: a square of it, lit from the upper left.

use anyhow::Result;
use relievo_cpu::{RenderOptions, Renderer};
use relievo_map::{Grid, MapSet};
use relievo_scene::{HeightRange, LoadOptions, Scene};

/// The scene; its material's maps are put in afterwards.
const SCENE: &str = include_str!("swatch.toml");

/// Draws `maps`, whose heights range over `height_scale` of a repeat.
pub(crate) fn swatch(maps: &MapSet, height_scale: f32, side: u32) -> Result<Grid<[u8; 3]>> {
    let mut scene = Scene::parse(SCENE, "the swatch", "".as_ref(), &LoadOptions::default())?;
    (scene.image.width, scene.image.height) = (side, side);
    for material in &mut scene.materials {
        material.height = HeightRange::Scale(height_scale);
        material.maps = maps.clone();
    }
    Ok(Renderer::new(&scene)?.render(&RenderOptions::default())?.pixels)
}
