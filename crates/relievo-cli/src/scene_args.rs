use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::Args;
use clap::builder::PossibleValuesParser;
use clap::builder::TypedValueParser;
use relievo_map::Limits;
use relievo_march::Shadow;
use relievo_scene::{LoadOptions, Override, Scene, SurfaceTechnique};

use crate::console::Console;

/// The scene that is drawn when none is named.
const WALL: &str = include_str!("../../../scenes/wall.toml");

/// Longest side of a picture, as in scene files.
const MAX_SIDE: u32 = 16384;

/// Which scene, and what is changed in it: the same for every command that draws.
#[derive(Args)]
pub(crate) struct SceneArguments {
    /// Scene file (TOML); without, the built-in brick wall
    scene: Option<PathBuf>,
    /// Change the scene: a path of keys and a value, as in camera.vertical_fov=30 (may be repeated)
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<Override>,
    /// Size of the picture in pixels, as in 800x600
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub(crate) size: Option<(u32, u32)>,
    /// Samples per pixel
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub(crate) samples: Option<u32>,
    /// Self-shadows of every material
    #[arg(long, value_name = "KIND", value_parser = PossibleValuesParser::new(Shadow::ALL.map(Shadow::name)).map(|name| shadow(&name)))]
    shadow: Option<Shadow>,
    /// Texels per side of generated materials ("make:…")
    #[arg(long, value_name = "N", default_value_t = 512, value_parser = clap::value_parser!(u32).range(1..=16384))]
    make_size: u32,
    /// Longest side of an image file that is accepted, in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = Limits::default().max_side, value_parser = clap::value_parser!(u32).range(1..))]
    max_image_side: u32,
    /// Memory an image file may take when decoded, in bytes
    #[arg(long, value_name = "BYTES", default_value_t = Limits::default().max_bytes)]
    max_image_bytes: u64,
    /// Threads to draw with; without, all cores
    #[arg(long, value_name = "N", value_parser = parse_threads)]
    pub(crate) threads: Option<usize>,
}

impl SceneArguments {
    /// Loads the scene, with every change that the command line asks for, and tells what was noticed.
    pub(crate) fn load(&self, console: &Console) -> Result<Scene> {
        let options = LoadOptions {
            overrides: self.overrides.clone(),
            limits: Limits { max_side: self.max_image_side, max_bytes: self.max_image_bytes },
            make_size: self.make_size,
        };
        let mut scene = match &self.scene {
            Some(path) => Scene::load(path, &options)?,
            None => Scene::parse(WALL, "the built-in wall", Path::new(""), &options)?,
        };
        for note in &scene.notes {
            console.note(note);
        }
        if let Some((width, height)) = self.size {
            (scene.image.width, scene.image.height) = (width, height);
        }
        if let Some(samples) = self.samples {
            scene.image.samples = samples;
        }
        if let Some(shadow) = self.shadow {
            for material in &mut scene.materials {
                material.relief.shadow = shadow;
            }
        }
        Ok(scene)
    }

    /// What to call the scene.
    pub(crate) fn title(&self) -> String {
        match &self.scene {
            Some(path) => path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy().into_owned(),
            None => "the built-in wall".to_owned(),
        }
    }

    /// Threads that will be used.
    pub(crate) fn thread_count(&self) -> usize {
        self.threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from))
    }
}

fn shadow(name: &str) -> Shadow {
    Shadow::from_name(name).unwrap_or_default()
}

/// A technique by its name, for `value_parser`.
pub(crate) fn technique_parser() -> impl TypedValueParser<Value = SurfaceTechnique> {
    PossibleValuesParser::new(SurfaceTechnique::names())
        .map(|name| SurfaceTechnique::from_name(&name).unwrap_or_default())
}

fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let side = |text: &str| text.trim().parse::<u32>().ok().filter(|n| (1..=MAX_SIDE).contains(n));
    text.split_once(['x', 'X', '×'])
        .and_then(|(width, height)| Some((side(width)?, side(height)?)))
        .ok_or_else(|| format!("expected WIDTHxHEIGHT, each from 1 to {MAX_SIDE}, as in 800x600"))
}

fn parse_threads(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|n| (1..=1024).contains(n)).ok_or_else(|| "expected a number from 1 to 1024".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_two_positive_numbers() {
        assert_eq!(parse_size("800x600"), Ok((800, 600)));
        assert_eq!(parse_size("1X1"), Ok((1, 1)));
        for bad in ["", "800", "0x600", "800x0", "-1x5", "1e3x5", "800x600x3", "70000x1", "x"] {
            assert!(parse_size(bad).is_err(), "{bad}");
        }
    }
}
