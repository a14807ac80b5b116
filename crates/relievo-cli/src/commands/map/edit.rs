use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use clap::{Args, ValueEnum};
use relievo_make::edit::{OtherMap, Step, apply_steps, apply_steps_to_color, apply_steps_to_normals};
use relievo_map::{
    Channel, ColorEncoding, ColorMap, Grid, HeightMap, Limits, NormalMap, NormalY, ScalarMap, White, Wrap, read_color,
    read_height, read_normal, read_scalar, write_color,
};
use serde::Serialize;

use super::batch::{self, Reads, VerbTask};
use super::job::MapJob;
use super::output::{MapOutput, UpOrDown};
use crate::console::{Console, WrongUsage};
use crate::memory::check_room;
use crate::scene_args::OUTPUT;

/// Edit a map: steps of image processing, done one after the other
#[derive(Args, Serialize)]
#[command(after_help = after_help())]
pub(crate) struct Arguments {
    /// A map, a material's folder, or a folder of materials or maps
    #[serde(skip)]
    input: PathBuf,
    /// What is done, in this order
    #[arg(required = true, value_name = "STEP")]
    steps: Vec<String>,
    /// The file to write; for a folder, the folder
    #[arg(long, short, value_name = "OUT", help_heading = OUTPUT)]
    #[serde(skip)]
    output: PathBuf,
    /// What the map is
    #[arg(long, value_name = "KIND", default_value = "height")]
    kind: MapKind,
    /// What lies beyond the border
    #[arg(long, value_name = "KIND", default_value = "wrap")]
    border: Beyond,
    /// Where +Y of the normals that are read points [default: up, or what a folder's file name says]
    #[arg(long, value_name = "WAY")]
    read_normal_y: Option<UpOrDown>,
    #[command(flatten)]
    maps: MapOutput,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum)]
enum MapKind {
    /// Heights
    Height,
    /// Normals
    Normal,
    /// Colours
    Color,
    /// One number per texel; of a material its roughness
    Scalar,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum)]
enum Beyond {
    /// The map tiles
    Wrap,
    /// It is mirrored
    Mirror,
    /// Its border goes on
    Clamp,
}

/// Examples, and every step with its meaning.
fn after_help() -> String {
    const EXAMPLES: &str = "Examples:
  relievo map edit height8.png deband -o height16.png
  relievo map edit height.png blur=0.01 levels=0.1,0.9,1.2 -o soft.png
  relievo map edit stones.png blend=sand.png,0.05 -o both.png
  relievo map edit normal.png rotate=90 --kind normal -o turned.png
  relievo map edit photo.png tile resize=1024x1024 --kind color -o tile.png

Steps:";
    let steps = Step::SYNTAX.iter().map(|step| format!("\n  {:<24}  {}", step.usage, step.summary));
    format!("{EXAMPLES}{}", steps.collect::<String>())
}

pub(crate) fn run(arguments: &Arguments, console: &Console) -> Result<()> {
    let steps = arguments.steps.iter().map(|text| read_step(text)).collect::<Result<Vec<_>>>()?;
    if arguments.kind == MapKind::Normal
        && let Some(k) = steps.iter().position(|step| step.orientation().is_none())
    {
        bail!(WrongUsage(format!(
            "normals can be rotated and flipped, but not edited by {}; make heights of them first (relievo map height)",
            arguments.steps[k]
        )));
    }
    let reads = match arguments.kind {
        MapKind::Height => Reads::Height,
        MapKind::Normal => Reads::Normal,
        MapKind::Color => Reads::Color,
        MapKind::Scalar => Reads::Scalar,
    };
    check_sizes(arguments, &steps)?;
    let task = VerbTask::new("edit", reads, arguments)?;
    batch::run(&arguments.input, &arguments.output, &task, console, |job| {
        edit_map(job, arguments, &steps, console).map(|path| vec![path])
    })
}

/// Reads a step; a wrong one is wrong usage.
fn read_step(text: &str) -> Result<Step> {
    Ok(text.parse().map_err(|error| WrongUsage(format!("{error}; relievo help map edit has every step")))?)
}

/// Refuses sizes that do not fit memory. The largest `resize` takes a map before and after, and half of it in between, for
/// each channel of colours.
fn check_sizes(arguments: &Arguments, steps: &[Step]) -> Result<()> {
    let sizes = steps.iter().filter_map(Step::output_size);
    let texels = sizes.map(|[width, height]| u64::from(width) * u64::from(height)).max().unwrap_or(0);
    let channels = if arguments.kind == MapKind::Color { 8 } else { 1 };
    let bytes = 4 * (2 + channels) * texels;
    check_room(bytes, "maps of this size", "a smaller one")
}

/// Edits one map and writes it.
fn edit_map(job: &MapJob, arguments: &Arguments, steps: &[Step], console: &Console) -> Result<PathBuf> {
    let wrap = match arguments.border {
        Beyond::Wrap => Wrap::Repeat,
        Beyond::Mirror => Wrap::Mirror,
        Beyond::Clamp => Wrap::Clamp,
    };
    let maps = &arguments.maps;
    let path = |suffix: &str| maps.path_for(job, suffix);
    let limits = Limits::default();
    let edited = |grid| apply_steps(grid, steps, wrap, other_height);
    match arguments.kind {
        MapKind::Height => {
            let white = job.found.as_ref().map_or(White::High, |found| found.height_white);
            let map = noted(read_height(&job.input, white, &limits)?, console);
            let path = path("Displacement")?;
            maps.height(&path, &HeightMap::new(edited(map.into_grid())?))?;
            Ok(path)
        }
        MapKind::Scalar => {
            let map = noted(read_scalar(&job.input, Channel::Luminance, &limits)?, console);
            let suffix = match &job.found {
                None => "Edited",
                Some(found) if found.roughness_is_gloss => "Gloss",
                Some(_) => "Roughness",
            };
            let path = path(suffix)?;
            maps.scalar(&path, &ScalarMap::new(edited(map.into_grid())?))?;
            Ok(path)
        }
        MapKind::Normal => {
            let found = job.found.as_ref().and_then(|found| found.normal.as_ref()).map(|(_, y)| *y);
            let normal_y: NormalY = arguments.read_normal_y.map(Into::into).or(found).unwrap_or_default();
            let map: NormalMap = noted(read_normal(&job.input, normal_y, &limits)?, console);
            let path = path(maps.normal_suffix())?;
            maps.normal(&path, &apply_steps_to_normals(map, steps)?)?;
            Ok(path)
        }
        MapKind::Color => {
            let map = noted(read_color(&job.input, &limits)?, console);
            let grid = apply_steps_to_color(&map.grid, steps, wrap, other_color)?;
            let path = path("Color")?;
            write_color(&path, &ColorMap { grid, encoding: map.encoding })?;
            Ok(path)
        }
    }
}

/// Shows the notes of a loaded map.
fn noted<T>(loaded: relievo_map::Loaded<T>, console: &Console) -> T {
    loaded.notes.iter().for_each(|note| console.note(note));
    loaded.map
}

/// Reads another map for a step, of one number per texel.
fn other_height(other: OtherMap<'_>) -> Result<Grid<f32>> {
    match other {
        OtherMap::Map(path) => Ok(read_height(path, White::High, &Limits::default())?.map.into_grid()),
        OtherMap::Mask(path) => read_mask(path),
    }
}

/// Reads one channel of another picture for a step, as display values.
fn other_color(other: OtherMap<'_>, channel: usize) -> Result<Grid<f32>> {
    match other {
        OtherMap::Map(path) => {
            let map = read_color(path, &Limits::default())?.map;
            let grid = if map.encoding == ColorEncoding::Linear { map.to_display() } else { map.grid };
            Ok(grid.map(|texel| texel[channel]))
        }
        OtherMap::Mask(path) => read_mask(path),
    }
}

fn read_mask(path: &Path) -> Result<Grid<f32>> {
    Ok(read_scalar(path, Channel::Luminance, &Limits::default())?.map.into_grid())
}
