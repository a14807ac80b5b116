use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use clap::{Args, ValueEnum};
use relievo_make::edit::{self, Combine, Turn, turned_normals};
use relievo_map::{
    Channel, ColorEncoding, ColorMap, Grid, HeightMap, Limits, MapError, NormalMap, NormalY, ScalarMap, White, Wrap,
    periodic, read_color, read_height, read_normal, read_scalar, write_color,
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
#[command(after_help = "Examples:
  relievo map edit height8.png deband -o height16.png
  relievo map edit height.png blur=0.01 levels=0.1,0.9,1.2 -o soft.png
  relievo map edit stones.png blend=sand.png,0.05 -o both.png
  relievo map edit normal.png rotate=90 --kind normal -o turned.png
  relievo map edit photo.png tile resize=1024x1024 --kind color -o tile.png

Steps:
  levels=LOW,HIGH[,GAMMA]   LOW becomes black, HIGH white
  curve=X:Y,X:Y,…           a curve through these points
  blur=R  sharpen=R,AMOUNT  with a Gaussian; R is a fraction of the width
  median=N                  of the N texels around, at most 16
  invert
  max=FILE  min=FILE        the higher or the lower of both maps
  add=FILE[,WEIGHT]
  blend=FILE,SOFTNESS       the higher of both, with soft corners
  mask=FILE,MASK            FILE where MASK is white
  resize=WxH                what tiles goes on tiling
  rotate=90|180|270         clockwise; normals turn too
  flip=x|y                  left to right, or upside down; normals too
  tile                      spreads the jumps at the borders, so that it tiles
  deband                    stair-steps of 8 bits become smooth")]
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
    kind: Kind,
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
enum Kind {
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

/// One step.
#[derive(Clone, Debug, PartialEq)]
enum Step {
    Levels([f32; 3]),
    Curve(Vec<[f32; 2]>),
    Blur(f32),
    Sharpen(f32, f32),
    Median(u32),
    Invert,
    Combine(Combine, PathBuf),
    Mask(PathBuf, PathBuf),
    Resize(u32, u32),
    Turn(Turn),
    Tile,
    Deband,
}

const STEPS: &str = "levels, curve, blur, sharpen, median, invert, max, min, add, blend, mask, resize, rotate, flip, \
                     tile, deband";

pub(crate) fn run(arguments: &Arguments, console: &Console) -> Result<()> {
    let steps = arguments.steps.iter().map(|text| parse(text)).collect::<Result<Vec<_>>>()?;
    let no_turn = |step: &Step| !matches!(step, Step::Turn(_));
    if arguments.kind == Kind::Normal
        && let Some(k) = steps.iter().position(no_turn)
    {
        bail!(WrongUsage(format!(
            "normals can be rotated and flipped, but not edited by {}; make heights of them first (relievo map height)",
            arguments.steps[k]
        )));
    }
    let reads = match arguments.kind {
        Kind::Height => Reads::Height,
        Kind::Normal => Reads::Normal,
        Kind::Color => Reads::Color,
        Kind::Scalar => Reads::Scalar,
    };
    check_sizes(arguments, &steps)?;
    let task = VerbTask::new("edit", reads, arguments)?;
    batch::run(&arguments.input, &arguments.output, &task, console, |job| {
        one(job, arguments, &steps, console).map(|path| vec![path])
    })
}

/// The memory that the largest `resize` takes: a map before and after, half of it in between, by channels of colours.
fn check_sizes(arguments: &Arguments, steps: &[Step]) -> Result<()> {
    let texels = |step: &Step| match step {
        Step::Resize(width, height) => u64::from(*width) * u64::from(*height),
        _ => 0,
    };
    let channels = if arguments.kind == Kind::Color { 8 } else { 1 };
    let bytes = 4 * (2 + channels) * steps.iter().map(texels).max().unwrap_or(0);
    check_room(bytes, "maps of this size", "a smaller one")
}

/// Edits one map and writes it.
fn one(job: &MapJob, arguments: &Arguments, steps: &[Step], console: &Console) -> Result<PathBuf> {
    let wrap = match arguments.border {
        Beyond::Wrap => Wrap::Repeat,
        Beyond::Mirror => Wrap::Mirror,
        Beyond::Clamp => Wrap::Clamp,
    };
    let maps = &arguments.maps;
    let path = |suffix: &str| maps.path_for(job, suffix);
    let limits = Limits::default();
    let edited = |grid: Grid<f32>, channel: usize| {
        steps.iter().try_fold(grid, |grid, step| apply(grid, step, wrap, arguments.kind, channel))
    };
    match arguments.kind {
        Kind::Height => {
            let white = job.found.as_ref().map_or(White::High, |found| found.height_white);
            let map = told(read_height(&job.input, white, &limits)?, console);
            let path = path("Displacement")?;
            maps.height(&path, &HeightMap::new(edited(map.into_grid(), 0)?))?;
            Ok(path)
        }
        Kind::Scalar => {
            let map = told(read_scalar(&job.input, Channel::Luminance, &limits)?, console);
            let suffix = match &job.found {
                None => "Edited",
                Some(found) if found.roughness_is_gloss => "Gloss",
                Some(_) => "Roughness",
            };
            let path = path(suffix)?;
            maps.scalar(&path, &ScalarMap::new(edited(map.into_grid(), 0)?))?;
            Ok(path)
        }
        Kind::Normal => {
            let found = job.found.as_ref().and_then(|found| found.normal.as_ref()).map(|(_, y)| *y);
            let normal_y: NormalY = arguments.read_normal_y.map(Into::into).or(found).unwrap_or_default();
            let map: NormalMap = told(read_normal(&job.input, normal_y, &limits)?, console);
            let turned = steps.iter().fold(map, |map, step| match step {
                Step::Turn(turn) => turned_normals(&map, *turn),
                _ => map,
            });
            let path = path(maps.normal_suffix())?;
            maps.normal(&path, &turned)?;
            Ok(path)
        }
        Kind::Color => {
            let map = told(read_color(&job.input, &limits)?, console);
            let channel = |k: usize| edited(map.grid.map(|c| c[k]), k);
            let [r, g, b, a] = [channel(0)?, channel(1)?, channel(2)?, channel(3)?];
            let grid =
                Grid::from_fn(r.width(), r.height(), |x, y| [*r.get(x, y), *g.get(x, y), *b.get(x, y), *a.get(x, y)]);
            let path = path("Color")?;
            write_color(&path, &ColorMap { grid, encoding: map.encoding })?;
            Ok(path)
        }
    }
}

fn told<T>(loaded: relievo_map::Loaded<T>, console: &Console) -> T {
    loaded.notes.iter().for_each(|note| console.note(note));
    loaded.map
}

/// Another map for a step, of the same kind; of colours the channel that is being edited.
fn other(path: &Path, kind: Kind, channel: usize) -> Result<Grid<f32>, MapError> {
    let limits = Limits::default();
    Ok(match kind {
        Kind::Color => {
            let map = read_color(path, &limits)?.map;
            let grid = if map.encoding == ColorEncoding::Linear { map.to_display() } else { map.grid };
            grid.map(|c| c[channel])
        }
        _ => read_height(path, White::High, &limits)?.map.into_grid(),
    })
}

fn apply(grid: Grid<f32>, step: &Step, wrap: Wrap, kind: Kind, channel: usize) -> Result<Grid<f32>> {
    let texels = |fraction: f32| fraction * grid.width() as f32;
    // Alpha is no colour: only its place in the picture changes.
    let alpha = kind == Kind::Color && channel == 3;
    if alpha && !matches!(step, Step::Resize(..) | Step::Turn(_)) {
        return Ok(grid);
    }
    Ok(match step {
        Step::Levels([low, high, gamma]) => edit::levels(&grid, *low, *high, *gamma),
        Step::Curve(points) => edit::curve(&grid, points)?,
        Step::Blur(radius) => edit::blur(&grid, texels(*radius), wrap),
        Step::Sharpen(radius, amount) => edit::sharpen(&grid, texels(*radius), *amount, wrap),
        Step::Median(radius) => edit::median(&grid, *radius, wrap)?,
        Step::Invert => edit::invert(&grid),
        Step::Combine(how, path) => edit::combine(&grid, &other(path, kind, channel)?, *how)?,
        Step::Mask(path, mask) => {
            let mask = read_scalar(mask, Channel::Luminance, &Limits::default())?.map;
            edit::masked(&grid, &other(path, kind, channel)?, mask.grid())?
        }
        Step::Resize(width, height) => edit::resize(&grid, *width, *height, wrap)?,
        Step::Turn(turn) => edit::turned(&grid, *turn),
        Step::Tile => periodic(&grid),
        Step::Deband => edit::deband(&grid, 255.0, wrap),
    })
}

/// A step as it is written: NAME or NAME=VALUES.
fn parse(text: &str) -> Result<Step> {
    let (name, value) = text.split_once('=').unwrap_or((text, ""));
    let wrong =
        |expected: &str| WrongUsage(format!("\"{text}\": expected {expected}; relievo help map edit has every step"));
    let numbers = |text: &str| -> Option<Vec<f32>> {
        text.split(',').map(|n| n.trim().parse::<f32>().ok().filter(|n| n.is_finite() && n.abs() <= 1e6)).collect()
    };
    let turn = |names: &[&str]| Turn::ALL.iter().find(|(n, _)| *n == value && names.contains(n)).map(|&(_, turn)| turn);
    let step = match name {
        "levels" => match numbers(value).as_deref() {
            Some(&[low, high]) => Some(Step::Levels([low, high, 1.0])),
            Some(&[low, high, gamma]) if gamma > 0.0 => Some(Step::Levels([low, high, gamma])),
            _ => None,
        }
        .ok_or_else(|| wrong("levels=LOW,HIGH or levels=LOW,HIGH,GAMMA, as in levels=0.1,0.9")),
        "curve" => {
            let point = |text: &str| numbers(&text.replace(':', ",")).and_then(|p| <[f32; 2]>::try_from(p).ok());
            let points = value.split(',').map(point).collect::<Option<Vec<_>>>().filter(|p| p.len() > 1);
            points.map(Step::Curve).ok_or_else(|| wrong("curve=X:Y,X:Y,…, as in curve=0:0,0.5:0.7,1:1"))
        }
        "blur" => match numbers(value).as_deref() {
            Some(&[radius]) if (0.0..=1.0).contains(&radius) => Some(Step::Blur(radius)),
            _ => None,
        }
        .ok_or_else(|| wrong("blur=R, R a fraction of the width from 0 to 1")),
        "sharpen" => match numbers(value).as_deref() {
            Some(&[radius, amount]) if (0.0..=1.0).contains(&radius) => Some(Step::Sharpen(radius, amount)),
            _ => None,
        }
        .ok_or_else(|| wrong("sharpen=R,AMOUNT, as in sharpen=0.002,1")),
        "median" => (value.parse().ok().filter(|n| *n <= edit::MAX_MEDIAN).map(Step::Median))
            .ok_or_else(|| wrong("median=N, N from 0 to 16")),
        "invert" if value.is_empty() => Ok(Step::Invert),
        "tile" if value.is_empty() => Ok(Step::Tile),
        "deband" if value.is_empty() => Ok(Step::Deband),
        "max" if !value.is_empty() => Ok(Step::Combine(Combine::Max, value.into())),
        "min" if !value.is_empty() => Ok(Step::Combine(Combine::Min, value.into())),
        "add" if !value.is_empty() => {
            // A number behind the last comma is the weight.
            let split = value.rsplit_once(',').and_then(|(path, n)| Some((path, *numbers(n)?.first()?)));
            let (path, weight) = split.unwrap_or((value, 1.0));
            Ok(Step::Combine(Combine::Add(weight), path.into()))
        }
        "blend" => {
            let split = value.rsplit_once(',').and_then(|(path, n)| Some((path, *numbers(n)?.first()?)));
            (split.filter(|(_, n)| *n > 0.0).map(|(path, n)| Step::Combine(Combine::Blend(n), path.into())))
                .ok_or_else(|| wrong("blend=FILE,SOFTNESS, as in blend=sand.png,0.05"))
        }
        "mask" => (value.rsplit_once(',').map(|(path, mask)| Step::Mask(path.into(), mask.into())))
            .ok_or_else(|| wrong("mask=FILE,MASK")),
        "resize" => {
            let side = |text: &str| text.parse::<u32>().ok().filter(|n| (1..=16384).contains(n));
            let size = value.split_once('x').and_then(|(w, h)| Some(Step::Resize(side(w)?, side(h)?)));
            size.ok_or_else(|| wrong("resize=WIDTHxHEIGHT, each from 1 to 16384"))
        }
        "rotate" => turn(&["90", "180", "270"]).map(Step::Turn).ok_or_else(|| wrong("rotate=90, 180 or 270")),
        "flip" => turn(&["x", "y"]).map(Step::Turn).ok_or_else(|| wrong("flip=x or flip=y")),
        _ => Err(wrong(&format!("one of the steps {STEPS}"))),
    };
    Ok(step?)
}
