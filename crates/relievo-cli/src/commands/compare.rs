use std::path::PathBuf;

use anyhow::{Result, bail};
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use relievo_lab::{CompareOptions, Contender, HeatMap, compare};
use relievo_map::write_atomic;

use crate::console::{Console, print};
use crate::picture::{check_folder, check_picture_path, write_picture};
use crate::scene_args::SceneArguments;

/// A sheet's pictures are at most this wide unless --size says otherwise.
const TILE_WIDTH: u32 = 400;

/// Samples per pixel unless the scene or --samples asks for more: the truth is to be free of jagged edges.
const SAMPLES: u32 = 4;

/// Draw a scene with several techniques, side by side with really displaced geometry
#[derive(Args)]
#[command(after_help = "Examples:
  relievo compare -o sheet.png
  relievo compare scenes/wall.toml --techniques normal,occlusion,exact --heat hits,fetches -o sheet.png --json sheet.json
  relievo compare --techniques displacement:10,displacement:100,exact --json -

Pictures are at most 400 pixels wide and have 4 samples per pixel unless --size and --samples say otherwise.
Every technique is lit at its hit, so that pictures differ by the march alone.")]
pub(crate) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// What to compare, separated by commas; displacement:N is a displaced grid of N vertices per side [default: all]
    #[arg(long, value_name = "A,B,…", value_delimiter = ',')]
    techniques: Vec<Contender>,
    /// The contact sheet (PNG)
    #[arg(long, short, value_name = "SHEET.png")]
    output: Option<PathBuf>,
    /// The figures as JSON; - for stdout
    #[arg(long, value_name = "FILE.json")]
    json: Option<PathBuf>,
    /// Heat maps under each picture: flip, hits, fetches
    #[arg(long, value_name = "MAPS", value_delimiter = ',', value_parser = heat_map_parser())]
    heat: Vec<HeatMap>,
    /// Vertices per side of the displaced truth [default: two per texel, fewer for large maps]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=8192))]
    truth_grid: Option<u32>,
}

fn heat_map_parser() -> impl TypedValueParser<Value = HeatMap> {
    PossibleValuesParser::new(HeatMap::ALL.map(|(name, _)| name)).map(|name| {
        let known = HeatMap::ALL.iter().find(|(known, _)| *known == name);
        known.map_or(HeatMap::Flip, |&(_, map)| map)
    })
}

pub(crate) fn run(arguments: &Arguments, console: &Console) -> Result<()> {
    if arguments.output.is_none() && arguments.json.is_none() {
        bail!("nothing would be written: name a sheet with -o SHEET.png or figures with --json FILE");
    }
    let to_stdout = arguments.json.as_ref().is_some_and(|path| path.as_os_str() == "-");
    arguments.output.as_deref().map_or(Ok(()), check_picture_path)?;
    if let Some(path) = arguments.json.as_deref().filter(|_| !to_stdout) {
        check_folder(path)?;
    }

    let mut scene = arguments.scene.load(console)?;
    let image = &mut scene.image;
    if arguments.scene.size.is_none() && image.width > TILE_WIDTH {
        image.height = (u64::from(image.height) * u64::from(TILE_WIDTH) / u64::from(image.width)).max(1) as u32;
        image.width = TILE_WIDTH;
    }
    if arguments.scene.samples.is_none() {
        image.samples = image.samples.max(SAMPLES);
    }

    let bar = console.progress(1);
    let progress = |what: &str, done: usize, all: usize| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
        bar.set_message(what.to_owned());
    };
    let mut options =
        CompareOptions { threads: arguments.scene.threads, grid: arguments.truth_grid, ..CompareOptions::default() };
    if !arguments.techniques.is_empty() {
        options.contenders.clone_from(&arguments.techniques);
    }
    options.progress = Some(&progress);
    let comparison = compare(&scene, &options)?;
    bar.finish_and_clear();

    if let Some(path) = &arguments.output {
        let title = format!("Relievo: {}", arguments.scene.title());
        write_picture(path, &comparison.sheet(&title, &arguments.heat)?)?;
    }
    if let Some(path) = &arguments.json {
        let json = serde_json::to_string_pretty(&comparison.summary())?;
        if to_stdout {
            print(format!("{json}\n").as_bytes())?;
        } else {
            write_atomic(path, |file| writeln!(file, "{json}"))?;
        }
    }
    Ok(())
}
