use std::path::{Path, PathBuf};

use anyhow::{Error, Result};
use clap::Args;
use clap::builder::PossibleValuesParser;
use clap::builder::TypedValueParser;
use relievo_map::{Limits, MapError};
use relievo_march::Shadow;
use relievo_scene::{
    AnimatedScene, ImageSettings, LoadOptions, Override, Scene, SceneError, SceneTime, SourceLocation, SurfaceTechnique,
};

use crate::console::{Console, WrongUsage, with_causes};
use crate::memory::check_room;

/// The scene that is drawn when none is named.
const WALL: &str = include_str!("../../../scenes/wall.toml");

/// The size of generated maps unless told otherwise, texels per side.
const MAKE_SIZE: u32 = 512;

/// Larger generated maps would take more memory than image files are allowed.
const MAX_MAKE_SIZE: u32 = 8192;

/// Memory for making a texel of a material's maps, with all that is needed on the way, in bytes (measured: 118).
const BYTES_PER_MADE_TEXEL: u64 = 128;

/// A scene and changes to it: the same for every command that draws.
#[derive(Args, Clone)]
pub(crate) struct SceneArguments {
    /// Scene file (TOML); without, the built-in brick wall
    scene: Option<PathBuf>,
    /// Change the scene: a path of keys and a value, as in camera.vertical_fov=30; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE", value_parser = parse_override, help_heading = SCENE)]
    overrides: Vec<Override>,
    /// Size of the picture in pixels, as in 800x600 [default: the scene's]
    #[arg(long, value_name = "WxH", value_parser = parse_size, allow_hyphen_values = true, help_heading = SCENE)]
    pub(crate) size: Option<(u32, u32)>,
    /// Samples per pixel, 1 to 4096 [default: the scene's]
    #[arg(long, value_name = "N", value_parser = whole_number(1, 4096), allow_negative_numbers = true, help_heading = SCENE)]
    pub(crate) samples: Option<u32>,
    /// Time of the scene in seconds: where keyframes and everything else that changes are
    #[arg(long, value_name = "SECONDS", default_value = "0", value_parser = parse_time, allow_negative_numbers = true, help_heading = SCENE)]
    pub(crate) time: SceneTime,
    /// Self-shadowing of every material's relief but mist's [default: the scene's]
    #[arg(long, value_name = "KIND", value_parser = PossibleValuesParser::new(Shadow::ALL.map(Shadow::name)).map(|name| shadow(&name)), help_heading = SCENE)]
    shadow: Option<Shadow>,
    /// Texels per side of generated materials (from = "make:…")
    #[arg(long, value_name = "N", default_value_t = MAKE_SIZE, value_parser = whole_number(1, MAX_MAKE_SIZE), allow_negative_numbers = true, help_heading = SCENE)]
    make_size: u32,
    /// Longest side of an image file that is accepted, in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = Limits::default().max_side, value_parser = whole_number(1, 1 << 16), allow_negative_numbers = true, help_heading = MACHINE)]
    max_image_side: u32,
    /// Memory an image file may take when decoded, in bytes
    #[arg(long, value_name = "BYTES", default_value_t = Limits::default().max_bytes, value_parser = parse_bytes, allow_negative_numbers = true, help_heading = MACHINE)]
    max_image_bytes: u64,
    /// Threads to draw with [default: one per core]
    #[arg(long, value_name = "N", value_parser = whole_number(1, 1024), allow_negative_numbers = true, help_heading = MACHINE)]
    threads: Option<u32>,
}

/// Headings of the help text.
pub(crate) const SCENE: &str = "The scene";
pub(crate) const OUTPUT: &str = "What is written";
pub(crate) const MACHINE: &str = "The machine";

impl SceneArguments {
    /// Loads the scene at its time, with every change that the command line asks for, and prints its notes.
    pub(crate) fn load(&self, console: &Console) -> Result<Scene> {
        let mut scene = self.open()?.at(self.time).map_err(refused)?;
        for note in &scene.notes {
            console.note(note);
        }
        self.prepare(&mut scene);
        Ok(scene)
    }

    /// Opens the scene for all times.
    pub(crate) fn open(&self) -> Result<AnimatedScene> {
        check_room(
            u64::from(self.make_size).pow(2) * BYTES_PER_MADE_TEXEL,
            &format!("generated maps of {0}×{0} texels", self.make_size),
            "a smaller --make-size",
        )?;
        let options = LoadOptions {
            overrides: self.overrides.clone(),
            limits: Limits { max_side: self.max_image_side, max_bytes: self.max_image_bytes },
            make_size: self.make_size,
            time: self.time,
        };
        let opened = match &self.scene {
            Some(path) => AnimatedScene::load(path, &options),
            None => AnimatedScene::parse(WALL, "the built-in wall", Path::new(""), &options),
        };
        opened.map_err(refused)
    }

    /// Makes the changes to a scene that the options beside `--set` ask for.
    pub(crate) fn prepare(&self, scene: &mut Scene) {
        if let Some((width, height)) = self.size {
            (scene.image.width, scene.image.height) = (width, height);
        }
        if let Some(samples) = self.samples {
            scene.image.samples = samples;
        }
        if let Some(shadow) = self.shadow {
            for material in scene.materials.iter_mut().filter(|material| !material.is_mist()) {
                material.relief.shadow = shadow;
            }
        }
    }

    /// The scene file, if one is named.
    pub(crate) fn path(&self) -> Option<&Path> {
        self.scene.as_deref()
    }

    /// Name of the scene in errors.
    pub(crate) fn name(&self) -> String {
        self.path().map_or_else(|| "the built-in wall".to_owned(), |path| path.display().to_string())
    }

    /// Name of the scene on a sheet.
    pub(crate) fn title(&self) -> String {
        let stem = |path: &Path| path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        self.path().map_or_else(|| self.name(), stem)
    }

    /// The arguments of a command that draws the scene as [`SceneArguments::load`] gives it, but for size and time.
    pub(crate) fn words(&self) -> Vec<String> {
        let limits = Limits::default();
        let mut words: Vec<String> = self.scene.iter().map(|path| path.display().to_string()).collect();
        let mut option = |name: &str, value: String| words.extend([name.to_owned(), value]);
        for change in &self.overrides {
            option("--set", change.to_string());
        }
        if let Some(samples) = self.samples {
            option("--samples", samples.to_string());
        }
        if let Some(shadow) = self.shadow {
            option("--shadow", shadow.name().to_owned());
        }
        if self.make_size != MAKE_SIZE {
            option("--make-size", self.make_size.to_string());
        }
        if self.max_image_side != limits.max_side {
            option("--max-image-side", self.max_image_side.to_string());
        }
        if self.max_image_bytes != limits.max_bytes {
            option("--max-image-bytes", self.max_image_bytes.to_string());
        }
        words
    }

    /// Threads asked for.
    pub(crate) fn threads(&self) -> Option<usize> {
        self.threads.map(|n| n as usize)
    }

    /// Threads that will be used.
    pub(crate) fn thread_count(&self) -> usize {
        self.threads().unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from))
    }
}

/// Errors in the text of a `--set` are wrong usage, whatever they are.
pub(crate) fn refused(error: SceneError) -> Error {
    let set = matches!(error.location(), Some(SourceLocation::Set(_)));
    let error = naming_the_option(error.into());
    if set { WrongUsage(with_causes(&error)).into() } else { error }
}

/// The library speaks of limits; here they are options.
fn naming_the_option(error: Error) -> Error {
    let option = error.chain().find_map(|cause| match cause.downcast_ref::<MapError>()? {
        MapError::Size { width: 1.., height: 1.., .. } => Some("--max-image-side"),
        MapError::Bytes { .. } | MapError::FileSize { .. } => Some("--max-image-bytes"),
        _ => None,
    });
    match option {
        Some(option) => anyhow::anyhow!("{error} ({option})"),
        None => error,
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

/// A number between two others, for `value_parser`.
pub(crate) fn number(min: f32, max: f32) -> impl Fn(&str) -> Result<f32, String> + Clone + Send + Sync + 'static {
    move |text| {
        let number = text.trim().parse().ok().filter(|x: &f32| (min..=max).contains(x));
        number.ok_or_else(|| format!("expected a number from {min} to {max}"))
    }
}

/// A whole number between two others, for `value_parser`; clap's own ranges are refused in Rust's notation.
pub(crate) fn whole_number(min: u32, max: u32) -> impl Fn(&str) -> Result<u32, String> + Clone + Send + Sync + 'static {
    move |text| {
        let number = text.trim().parse().ok().filter(|n| (min..=max).contains(n));
        number.ok_or_else(|| format!("expected a whole number from {min} to {max}"))
    }
}

fn parse_time(text: &str) -> Result<SceneTime, String> {
    let seconds = text.trim().parse().ok().and_then(SceneTime::from_seconds);
    seconds.ok_or_else(|| {
        format!("expected a number of seconds of magnitude at most {:e}, as in 2.5", SceneTime::MAX_SECONDS)
    })
}

fn parse_bytes(text: &str) -> Result<u64, String> {
    text.trim().parse().map_err(|_| "expected a whole number of bytes, as in 1073741824".to_owned())
}

fn parse_override(text: &str) -> Result<Override, String> {
    text.parse().map_err(|_| "expected PATH=VALUE, as in camera.vertical_fov=30".to_owned())
}

pub(crate) fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let max = ImageSettings::MAX_SIDE;
    let side = |text: &str| text.trim().parse::<u32>().ok().filter(|n| (1..=max).contains(n));
    let (width, height) = text
        .split_once(['x', 'X', '×'])
        .and_then(|(width, height)| Some((side(width)?, side(height)?)))
        .ok_or_else(|| format!("expected WIDTHxHEIGHT, each from 1 to {max}, as in 800x600"))?;
    if u64::from(width) * u64::from(height) > ImageSettings::MAX_PIXELS {
        return Err(format!("these are too many pixels: at most {} in all", ImageSettings::MAX_PIXELS));
    }
    Ok((width, height))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_two_positive_numbers_with_a_bearable_product() {
        assert_eq!(parse_size("800x600"), Ok((800, 600)));
        assert_eq!(parse_size("1X1"), Ok((1, 1)));
        assert_eq!(parse_size("16384x8192"), Ok((16384, 8192)));
        for bad in ["", "800", "0x600", "800x0", "-1x5", "1e3x5", "800x600x3", "70000x1", "x", "16384x8193"] {
            assert!(parse_size(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn whole_numbers_keep_to_their_range() {
        let parse = whole_number(1, 40);
        assert_eq!((parse("1"), parse("40")), (Ok(1), Ok(40)));
        for bad in ["0", "41", "-1", "1.5", "", "x", "99999999999"] {
            assert_eq!(parse(bad), Err("expected a whole number from 1 to 40".to_owned()), "{bad}");
        }
    }
}
