use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use relievo_lab::{CompareOptions, HeatMap, TechniqueSpec, TechniqueSpecError, check_sheet, compare};
use relievo_map::write_picture;

use crate::console::{Console, WrongUsage};
use crate::memory::check_room;
use crate::outputs::{check_outputs, picture_parser, write_json};
use crate::scene_args::{OUTPUT, SceneArguments, whole_number};

/// A sheet's pictures are at most this wide unless --size says otherwise.
const TILE_WIDTH: u32 = 400;

/// Samples per pixel unless the scene or --samples asks for more: the truth is to be free of jagged edges.
const SAMPLES: u32 = 4;

/// Memory for a pixel in bytes: while it is drawn, and for each technique with its heat maps and its place on the sheet
/// (measured: 170 and 80).
const BYTES_PER_PIXEL: [u64; 2] = [200, 100];

/// Draw a scene with several techniques, side by side with really displaced geometry
#[derive(Args)]
#[command(after_help = "Examples:
  relievo compare -o sheet.png
  relievo compare scenes/sphere.toml --techniques steep,relief,exact --heat hits -o sheet.png
  relievo compare --techniques displacement:10,displacement:100,exact --json -

Pictures are at most 400 pixels wide and have 4 samples per pixel unless --size and --samples say otherwise. Every technique is lit at its hit, so that pictures differ by the march alone.")]
pub(crate) struct Arguments {
    /// Techniques to compare, separated by commas, with settings as in occlusion:8..32 (layers), relief:8..32+5 (and
    /// bisections), displacement:100 (vertices per side), or tutorials, bevy, bevy-relief: those rules [default: all]
    #[arg(long, value_name = "A,B,…", value_delimiter = ',', value_parser = parse_technique)]
    techniques: Vec<TechniqueSpec>,
    /// Vertices per side of the displaced truth's picture [default: two per texel]
    #[arg(long, value_name = "N", value_parser = whole_number(2, 8192), allow_negative_numbers = true)]
    truth_grid: Option<u32>,
    /// The contact sheet (PNG)
    #[arg(long, short, value_name = "SHEET.png", value_parser = picture_parser(), help_heading = OUTPUT)]
    output: Option<PathBuf>,
    /// The figures as JSON; - for stdout
    #[arg(long, value_name = "FILE.json", help_heading = OUTPUT)]
    json: Option<PathBuf>,
    /// Heat maps under each picture, separated by commas: the error that is seen, how far hits are off, what they cost
    #[arg(long, value_name = "MAPS", value_delimiter = ',', value_parser = heat_map_parser(), help_heading = OUTPUT)]
    heat: Vec<HeatMap>,
    #[command(flatten)]
    scene: SceneArguments,
}

/// Parses a technique that can be drawn: `exact:cells` cannot.
fn parse_technique(text: &str) -> Result<TechniqueSpec, String> {
    let spec = text.parse().ok().filter(|spec: &TechniqueSpec| !spec.cell_by_cell);
    spec.ok_or_else(TechniqueSpecError::expected)
}

fn heat_map_parser() -> impl TypedValueParser<Value = HeatMap> {
    PossibleValuesParser::new(HeatMap::ALL.map(|(name, _)| name)).map(|name| {
        let known = HeatMap::ALL.iter().find(|(known, _)| *known == name);
        known.map_or(HeatMap::Flip, |&(_, map)| map)
    })
}

pub(crate) fn run(arguments: &Arguments, console: &Console) -> Result<()> {
    if arguments.output.is_none() && arguments.json.is_none() {
        let nothing = "nothing would be written; name a sheet with -o SHEET.png, or figures with --json FILE.json";
        bail!(WrongUsage(nothing.to_owned()));
    }
    let outputs: Vec<&Path> = arguments.output.as_deref().into_iter().chain(arguments.json.as_deref()).collect();
    check_outputs(&outputs, arguments.scene.path())?;

    let mut scene = arguments.scene.load(console)?;
    let image = &mut scene.image;
    if arguments.scene.size.is_none() && image.width > TILE_WIDTH {
        image.height = (u64::from(image.height) * u64::from(TILE_WIDTH) / u64::from(image.width)).max(1) as u32;
        image.width = TILE_WIDTH;
    }
    if arguments.scene.samples.is_none() {
        image.samples = image.samples.max(SAMPLES);
    }

    let mut options =
        CompareOptions { threads: arguments.scene.threads(), grid: arguments.truth_grid, ..CompareOptions::default() };
    if !arguments.techniques.is_empty() {
        options.techniques.clone_from(&arguments.techniques);
    }
    let (width, height) = (image.width, image.height);
    if arguments.output.is_some() {
        check_sheet([width, height], options.techniques.len(), arguments.heat.len())?;
    }
    let [drawing, kept] = BYTES_PER_PIXEL;
    check_room(
        u64::from(width) * u64::from(height) * (drawing + kept * options.techniques.len() as u64),
        &format!("{} pictures of {width}×{height} pixels", options.techniques.len()),
        "a smaller --size or fewer --techniques",
    )?;

    let bar = console.progress(1);
    let progress = |what: &str, done: usize, all: usize| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
        bar.set_message(what.to_owned());
    };
    options.progress = Some(&progress);
    let comparison = compare(&scene, &options).with_context(|| arguments.scene.name())?;
    bar.finish_and_clear();
    for note in &comparison.truth_notes {
        console.note(note);
    }

    if let Some(path) = &arguments.output {
        let title = format!("Relievo: {}", arguments.scene.title());
        write_picture(path, &comparison.sheet(&title, &arguments.heat)?)?;
    }
    if let Some(path) = &arguments.json {
        write_json(path, &comparison.summary())?;
    }
    Ok(())
}
