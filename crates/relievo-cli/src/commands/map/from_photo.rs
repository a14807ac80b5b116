use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use relievo_make::{ColorPick, PhotoEdge, PhotoOptions, PhotoPreset, SideLight, from_photo};
use relievo_map::{Channel, Limits, MapSet, ScalarMap, read_color, read_scalar};
use serde::Serialize;

use super::batch::{self, Reads, VerbTask};
use super::job::{JobOutput, is_same};
use super::output::MapOutput;
use super::surface::by_debug;
use crate::console::{Console, WrongUsage};
use crate::memory::check_room;
use crate::scene_args::{OUTPUT, number};

/// Memory for making a texel, the picture included, in bytes; and more where waves are solved for.
const BYTES_PER_TEXEL: u64 = 40;
const BYTES_OF_WAVES: u64 = 40;

/// Make heights from the light and dark of a colour picture, with normals, occlusion and roughness
///
/// Light is taken linear and freed of uneven lighting; what is left of light and of saturation is taken apart by scale, and
/// put together with the weights of a preset.
#[derive(Args, Serialize)]
#[command(after_help = "Examples:
  relievo map from-photo wall.jpg -o wall --preset brick
  relievo map from-photo wall.jpg -o wall --pick '#a8a090:-0.5'          the mortar's colour lies deeper
  relievo map from-photo sand.jpg -o sand --side-light 135 --edge make-tile
  relievo map from-photo photos -o materials --preset stone              every picture or material in a folder

Weights are lists of 7 numbers, from bands of a thousandth of the width to those of a sixteenth; positive: what is dark (or grey) is deep.")]
pub(crate) struct Arguments {
    /// A picture, a material's folder, or a folder of materials or pictures
    #[serde(skip)]
    input: PathBuf,
    /// The folder for the maps; it is made if need be
    #[arg(long, short, value_name = "FOLDER", help_heading = OUTPUT)]
    #[serde(skip)]
    output: PathBuf,
    /// Subject of the picture
    #[arg(long, value_name = "KIND", default_value = "stone", value_parser = preset_parser())]
    #[serde(serialize_with = "by_debug")]
    preset: PhotoPreset,
    /// Weights of the bands of light [default: the preset's]
    #[arg(long, value_name = "7 NUMBERS", value_parser = weights, allow_hyphen_values = true)]
    light: Option<[f32; 7]>,
    /// Weights of the bands of saturation [default: the preset's]
    #[arg(long, value_name = "7 NUMBERS", value_parser = weights, allow_hyphen_values = true)]
    saturation: Option<[f32; 7]>,
    /// Light changes wider than this fraction of the width are uneven lighting; 0 keeps them [default: the preset's]
    #[arg(long, value_name = "R", value_parser = number(0.0, 1.0))]
    flatten: Option<f32>,
    /// Direction that the light came from, in degrees: 0 right, 90 above; adds heights by shading
    #[arg(long, value_name = "DEGREES", value_parser = number(-360.0, 360.0), allow_negative_numbers = true)]
    side_light: Option<f32>,
    /// Weight of the shading
    #[arg(long, value_name = "W", default_value_t = 1.0, value_parser = number(-10.0, 10.0), requires = "side_light", allow_negative_numbers = true)]
    shading: f32,
    /// A colour that lies higher or lower: #RRGGBB:OFFSET or #RRGGBB:OFFSET:TOLERANCE; may be repeated
    #[arg(long, value_name = "PICK", value_parser = pick)]
    #[serde(serialize_with = "by_debug")]
    pick: Vec<ColorPick>,
    /// A picture that is black where heights are to stay plain
    #[arg(long, value_name = "MASK")]
    mask: Option<PathBuf>,
    /// Radius of the smoothing that keeps edges, as a fraction of the width [default: the preset's]
    #[arg(long, value_name = "R", value_parser = number(0.0, 0.1))]
    clean: Option<f32>,
    /// Shares of texels, in percent, that become black and white
    #[arg(long, value_name = "LOW,HIGH", value_parser = levels, default_value = "0.5,99.5")]
    levels: [f32; 2],
    /// Picture beyond its border
    #[arg(long, value_name = "KIND", default_value = "open")]
    edge: Edge,
    /// The full range of heights as a fraction of the width [default: the preset's]
    #[arg(long, value_name = "S", value_parser = number(0.0, 100.0))]
    height_scale: Option<f32>,
    #[command(flatten)]
    maps: MapOutput,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum)]
enum Edge {
    /// It ends there
    Open,
    /// The picture tiles as it is
    Tiles,
    /// The picture is made to tile
    MakeTile,
}

pub(crate) fn run(arguments: &Arguments, console: &Console) -> Result<()> {
    let options = options(arguments, console)?;
    if arguments.input.is_dir() {
        let task = VerbTask::new("from-photo", Reads::Color, arguments)?;
        return batch::run(&arguments.input, &arguments.output, &task, console, |job| {
            let JobOutput::Folder { folder, name } = &job.output else { return Ok(Vec::new()) };
            one(&job.input, &folder.join(name), name, &options, &arguments.maps, console)
        });
    }
    let stem = arguments.input.file_stem().unwrap_or_default().to_string_lossy();
    one(&arguments.input, &arguments.output, material_of(&stem), &options, &arguments.maps, console).map(drop)
}

/// The name of the material whose colour a file is: without the ending that says so.
fn material_of(stem: &str) -> &str {
    const ENDINGS: [&str; 6] = ["_color", "_colour", "_albedo", "_basecolor", "_diffuse", "_diff"];
    let lower = stem.to_ascii_lowercase();
    let ending = ENDINGS.iter().find(|ending| lower.ends_with(*ending) && lower.len() > ending.len());
    ending.map_or(stem, |ending| &stem[..stem.len() - ending.len()])
}

/// Makes the maps of one picture and returns the files.
fn one(
    input: &Path,
    folder: &Path,
    name: &str,
    options: &PhotoOptions,
    maps: &MapOutput,
    console: &Console,
) -> Result<Vec<PathBuf>> {
    maps.check_material(folder, name)?;
    let loaded = read_color(input, &Limits::default())?;
    loaded.notes.iter().for_each(|note| console.note(note));
    let photo = loaded.map;
    let texels = u64::from(photo.grid.width()) * u64::from(photo.grid.height());
    let waves = options.side_light.is_some() || options.edge == PhotoEdge::MakeTile;
    let bytes = BYTES_PER_TEXEL + if waves { BYTES_OF_WAVES } else { 0 };
    check_room(texels * bytes, "the maps of this picture", "a smaller picture")?;
    let there = maps.path(folder, name, "Color");
    let itself = is_same(&there, input);
    if itself && options.edge == PhotoEdge::MakeTile {
        anyhow::bail!("{}: made to tile, the picture would be overwritten; choose another folder", input.display());
    }
    let made = from_photo(photo, options).map_err(|error| anyhow::anyhow!("{}: {error}", input.display()))?;
    // Each map is gone when it is written, before the next one is made.
    let (color, height) = (made.color, made.height);
    let mut files = if itself { vec![there] } else { Vec::new() };
    let mut write = |set: MapSet| maps.material(folder, name, &set).map(|written| files.extend(written));
    // The colour may be there already.
    write(MapSet {
        base_color: Some(color).filter(|_| !itself),
        roughness: Some(made.roughness),
        ..MapSet::default()
    })?;
    write(MapSet { normal: Some(options.normal(&height)), ..MapSet::default() })?;
    write(MapSet { ao: Some(options.ao(&height)), ..MapSet::default() })?;
    write(MapSet { height: Some(height), ..MapSet::default() })?;
    Ok(files)
}

fn options(arguments: &Arguments, console: &Console) -> Result<PhotoOptions> {
    let mut options = arguments.preset.options();
    options.light = arguments.light.unwrap_or(options.light);
    options.saturation = arguments.saturation.unwrap_or(options.saturation);
    options.flatten = arguments.flatten.unwrap_or(options.flatten);
    options.side_light = arguments.side_light.map(|angle| SideLight { angle, weight: arguments.shading });
    options.picks.clone_from(&arguments.pick);
    options.clean = arguments.clean.unwrap_or(options.clean);
    options.levels = arguments.levels;
    options.height_scale = arguments.height_scale.unwrap_or(options.height_scale);
    options.edge = match arguments.edge {
        Edge::Open => PhotoEdge::Open,
        Edge::Tiles => PhotoEdge::Tiles,
        Edge::MakeTile => PhotoEdge::MakeTile,
    };
    if let Some(path) = &arguments.mask {
        if arguments.input.is_dir() {
            anyhow::bail!(WrongUsage("a mask belongs to one picture; leave out --mask for a folder".to_owned()));
        }
        let loaded = read_scalar(path, Channel::Luminance, &Limits::default())?;
        loaded.notes.iter().for_each(|note| console.note(note));
        let map: ScalarMap = loaded.map;
        options.mask = Some(map);
    }
    Ok(options)
}

fn preset_parser() -> impl TypedValueParser<Value = PhotoPreset> {
    PossibleValuesParser::new(PhotoPreset::ALL.map(|(name, _)| name)).map(|name| {
        let known = PhotoPreset::ALL.iter().find(|(known, _)| *known == name);
        known.map_or(PhotoPreset::Stone, |&(_, preset)| preset)
    })
}

fn numbers<const N: usize>(text: &str, limit: f32) -> Option<[f32; N]> {
    let numbers: Option<Vec<f32>> =
        text.split(',').map(|n| n.trim().parse::<f32>().ok().filter(|n| n.abs() <= limit)).collect();
    numbers?.try_into().ok()
}

fn weights(text: &str) -> Result<[f32; 7], String> {
    numbers(text, 100.0).ok_or_else(|| "expected 7 numbers from -100 to 100, as in 0.1,0.1,0.5,1,1,1,0.5".to_owned())
}

fn levels(text: &str) -> Result<[f32; 2], String> {
    let levels = numbers(text, 100.0).filter(|[low, high]: &[f32; 2]| *low >= 0.0 && low < high);
    levels.ok_or_else(|| "expected two shares in percent that rise, as in 1,99".to_owned())
}

fn pick(text: &str) -> Result<ColorPick, String> {
    let wrong = || "expected #RRGGBB:OFFSET or #RRGGBB:OFFSET:TOLERANCE, as in #a8a090:-0.5".to_owned();
    let mut parts = text.trim().strip_prefix('#').ok_or_else(wrong)?.split(':');
    let digits = parts.next().filter(|d| d.len() == 6 && d.bytes().all(|b| b.is_ascii_hexdigit())).ok_or_else(wrong)?;
    let color = u32::from_str_radix(digits, 16).map_err(|_| wrong())?;
    let mut next = |low: f32, high: f32| {
        parts.next().map(|n| n.parse::<f32>().ok().filter(|n| (low..=high).contains(n)).ok_or_else(wrong)).transpose()
    };
    let offset = next(-2.0, 2.0)?.ok_or_else(wrong)?;
    let tolerance = next(0.1, 100.0)?.unwrap_or(10.0);
    if parts.next().is_some() {
        return Err(wrong());
    }
    let color = [color >> 16, color >> 8 & 255, color & 255].map(|c| c as f32 / 255.0);
    Ok(ColorPick { color, offset, tolerance })
}
