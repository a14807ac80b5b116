use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use relievo_journal::{ContentHash, Input};
use relievo_make::paint::{Brush, Profile, Stroke, paint, strokes_from_file, strokes_from_svg};
use relievo_map::{Grid, HeightMap, Limits, White, read_height};
use serde::Serialize;

use super::batch::{self, Reads, VerbTask};
use super::output::MapOutput;
use super::surface::{WrapOrOpen, by_debug};
use crate::console::Console;
use crate::memory::check_room;
use crate::outputs::{check_outputs, extension};
use crate::scene_args::{OUTPUT, number, whole_number};

/// Longest file of strokes that is read, in bytes.
const MAX_BYTES: u64 = 1 << 24;

/// Paint strokes into heights: cracks and tracks by hand, from an SVG drawing or a stroke file
#[derive(Args, Serialize)]
#[command(after_help = "Examples:
  relievo map paint cracks.svg --on ground_height.png -o cracked_height.png --depth -0.4 --jitter 0.004
  relievo map paint tracks.toml --size 1024x1024 -o tracks_height.png
  relievo map paint cracks.svg --on materials -o cracked               every material in a folder

The drawing's viewBox becomes the map. A stroke file is TOML: width, depth, profile, hardness, jitter, taper for all strokes, and a table [[strokes]] with points = [[u, v], …] for each; what the file says goes before the options.")]
pub(crate) struct Arguments {
    /// Strokes: an SVG drawing (.svg) or a stroke file (.toml)
    #[serde(skip)]
    strokes: PathBuf,
    /// Paint on this height map, material or folder of materials [default: a plain of --level]
    #[arg(long, value_name = "MAP", conflicts_with_all = ["size", "level"])]
    #[serde(skip)]
    on: Option<PathBuf>,
    /// Size of the plain, as in 1024x1024
    #[arg(long, value_name = "WxH", value_parser = size, default_value = "1024x1024")]
    size: (u32, u32),
    /// Height of the plain
    #[arg(long, value_name = "H", value_parser = number(0.0, 1.0), default_value_t = 0.75)]
    level: f32,
    /// The file to write; for a folder, the folder
    #[arg(long, short, value_name = "OUT", help_heading = OUTPUT)]
    #[serde(skip)]
    output: PathBuf,
    /// Height added in the middle of a stroke, of the range of heights; negative carves
    #[arg(long, value_name = "D", default_value_t = -0.3, value_parser = number(-1.0, 1.0), allow_negative_numbers = true)]
    depth: f32,
    /// Profile across a stroke
    #[arg(long, value_name = "KIND", default_value = "round", value_parser = PossibleValuesParser::new(Profile::ALL.map(|(name, _)| name)).map(|name| profile(&name)))]
    #[serde(serialize_with = "by_debug")]
    profile: Profile,
    /// The part of the half width that is as deep as the middle
    #[arg(long, value_name = "H", default_value_t = 0.0, value_parser = number(0.0, 1.0))]
    hardness: f32,
    /// Distance that strokes stray, as a fraction of the width of the map
    #[arg(long, value_name = "R", default_value_t = 0.0, value_parser = number(0.0, 1.0))]
    jitter: f32,
    /// Let the ends run out
    #[arg(long)]
    taper: bool,
    /// Another seed strays otherwise
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = whole_number(0, u32::MAX), allow_negative_numbers = true)]
    seed: u32,
    /// Surface beyond the border: strokes go on at the other side, or end
    #[arg(long, value_name = "KIND", default_value = "wrap")]
    border: WrapOrOpen,
    #[command(flatten)]
    maps: MapOutput,
}

fn profile(name: &str) -> Profile {
    Profile::ALL.iter().find(|(known, _)| *known == name).map_or(Profile::Round, |&(_, profile)| profile)
}

fn size(text: &str) -> Result<(u32, u32), String> {
    let side = |text: &str| text.trim().parse::<u32>().ok().filter(|n| (1..=16384).contains(n));
    let size = text.split_once(['x', '×']).and_then(|(w, h)| Some((side(w)?, side(h)?)));
    size.ok_or_else(|| "expected WIDTHxHEIGHT, each from 1 to 16384, as in 1024x1024".to_owned())
}

pub(crate) fn run(arguments: &Arguments, console: &Console) -> Result<()> {
    let text = read(&arguments.strokes)?;
    let strokes = strokes(arguments, &text)?;
    let wrap = arguments.border == WrapOrOpen::Wrap;
    let painted = |heights: &Grid<f32>| HeightMap::new(paint(heights, &strokes, wrap, arguments.seed));
    let Some(on) = &arguments.on else {
        check_outputs(&[&arguments.output], None)?;
        let (width, height) = arguments.size;
        // The plain, the painted one, and what the strokes of a band come to.
        check_room(12 * u64::from(width) * u64::from(height), "maps of this size", "a smaller --size")?;
        return arguments.maps.height(&arguments.output, &painted(&Grid::filled(width, height, arguments.level)));
    };
    // The strokes themselves: another drawing under the same name is other work.
    let drawing = Input::of_content(&arguments.strokes.to_string_lossy(), ContentHash::of(text.as_bytes()));
    let task = VerbTask::new("paint", Reads::Height, arguments)?.reading(drawing);
    batch::run(on, &arguments.output, &task, console, |job| {
        let white = job.found.as_ref().map_or(White::High, |found| found.height_white);
        let loaded = read_height(&job.input, white, &Limits::default())?;
        loaded.notes.iter().for_each(|note| console.note(note));
        let path = arguments.maps.path_for(job, "Displacement")?;
        arguments.maps.height(&path, &painted(loaded.map.grid()))?;
        Ok(vec![path])
    })
}

fn strokes(arguments: &Arguments, text: &str) -> Result<Vec<Stroke>> {
    let path = &arguments.strokes;
    let name = path.display().to_string();
    let brush = Brush {
        depth: arguments.depth,
        profile: arguments.profile,
        hardness: arguments.hardness,
        jitter: arguments.jitter,
        taper: arguments.taper,
        ..Brush::default()
    };
    match extension(path).as_str() {
        "svg" => Ok(strokes_from_svg(&name, text, &brush)?),
        "toml" => Ok(strokes_from_file(&name, text, &brush)?),
        _ => bail!("{name}: strokes come from an SVG drawing (.svg) or a stroke file (.toml)"),
    }
}

fn read(path: &Path) -> Result<String> {
    let Ok(metadata) = std::fs::metadata(path) else {
        bail!("{}: there is no such file; check the spelling and the folder", path.display());
    };
    if !metadata.is_file() || metadata.len() > MAX_BYTES {
        bail!("{}: strokes are a text file of at most {} MiB", path.display(), MAX_BYTES >> 20);
    }
    let bytes = std::fs::read(path).with_context(|| format!("{}: the file cannot be read", path.display()))?;
    String::from_utf8(bytes).map_err(|_| anyhow::anyhow!("{}: this is no text in UTF-8", path.display()))
}
