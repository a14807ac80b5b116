use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use relievo_lab::{
    ErrorUnit, TechniqueCost, TestMaterial, Trial, TuneOptions, TuneOutcome, corpus_names, edit_scene, new_scene, tune,
};
use relievo_map::write_atomic;
use relievo_scene::{HeightRange, LoadOptions, Scene};

use super::lab::{Backends, benches, load};
use crate::console::{Console, WrongUsage, print};
use crate::outputs::{check_outputs, extension, write_json};
use crate::scene_args::{MACHINE, OUTPUT, SCENE, number, whole_number};

/// The full depth as a fraction of a repeat, where nothing says it: a scene's own default.
const HEIGHT_SCALE: f32 = 0.1;

/// Find the cheapest technique that keeps an error, and write it into a scene
///
/// Tries every technique with its settings under all angles up to the largest, against an oracle in double precision, and
/// takes the cheapest of those that keep the error.
#[derive(Args)]
#[command(after_help = "Examples:
  relievo tune make:brick-wall --max-error 1
  relievo tune make:cobbles --max-error 0.5 --angle-max 60 -o cobbles.toml
  relievo tune make:brick-wall --max-error 2 --unit pixels --write scenes/wall.toml
  relievo tune make:terrain --max-error 0.02 --unit flip --cost fetches --json -

An error in texels or pixels is that of 99 % of the hits; FLIP is that of a picture.")]
pub(crate) struct Arguments {
    /// A folder of maps, a height map, make:NAME, or solid, airy, noise, spikes (the lab's own)
    #[arg(value_name = "MATERIAL")]
    material: String,
    /// The largest error that is allowed
    #[arg(long, value_name = "E", value_parser = number(0.0, 1e6), allow_negative_numbers = true)]
    max_error: f32,
    /// Unit of the error
    #[arg(long, value_name = "UNIT", default_value = "texels", value_parser = PossibleValuesParser::new(ErrorUnit::ALL.map(|(name, _)| name)).map(|name| unit(&name)))]
    unit: ErrorUnit,
    /// The largest angle from the normal, degrees
    #[arg(long, value_name = "DEGREES", default_value_t = 80.0, value_parser = number(0.0, 89.9), allow_negative_numbers = true)]
    angle_max: f32,
    /// The full range of heights as a fraction of one repeat along u [default: the scene's or the maker's own, else 0.1]
    #[arg(long, value_name = "S", value_parser = number(0.0, 100.0), allow_negative_numbers = true)]
    height_scale: Option<f32>,
    /// The same in texels
    #[arg(long, value_name = "TEXELS", conflicts_with = "height_scale", value_parser = number(0.0, 4096.0), allow_negative_numbers = true)]
    depth: Option<f32>,
    /// The cost that is to be low: the measured time, or the number of fetches, which is the same on every machine
    #[arg(long, value_name = "KIND", default_value = "time", value_parser = PossibleValuesParser::new(TechniqueCost::ALL.map(|(name, _)| name)).map(|name| cost(&name)))]
    cost: TechniqueCost,
    /// Rays per angle
    #[arg(long, value_name = "N", default_value_t = 4096, value_parser = whole_number(32, 1 << 22), allow_negative_numbers = true)]
    rays: u32,
    /// Texels per side of a generated material
    #[arg(long, value_name = "N", default_value_t = 512, value_parser = whole_number(1, 8192), allow_negative_numbers = true, help_heading = SCENE)]
    size: u32,
    /// A new scene with the material, for `relievo render`
    #[arg(long, short, value_name = "SCENE.toml", help_heading = OUTPUT)]
    output: Option<PathBuf>,
    /// A scene that is there: the technique goes into its material, all else stays
    #[arg(long, value_name = "SCENE.toml", conflicts_with = "output", help_heading = OUTPUT)]
    write: Option<PathBuf>,
    /// The material in that scene [default: the only one]
    #[arg(long, value_name = "NAME", requires = "write", help_heading = OUTPUT)]
    into: Option<String>,
    /// All that was tried, as JSON; - for stdout
    #[arg(long, value_name = "FILE.json", help_heading = OUTPUT)]
    json: Option<PathBuf>,
    /// The backend on which it is to be cheap
    #[arg(long, value_enum, default_value_t = TuneBackend::Cpu, help_heading = MACHINE)]
    backend: TuneBackend,
    /// The GPU, by a part of its name as `relievo devices` lists it
    #[arg(long, value_name = "NAME", help_heading = MACHINE)]
    adapter: Option<String>,
}

/// The backend on which marches are timed.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum TuneBackend {
    Cpu,
    Gpu,
}

fn unit(name: &str) -> ErrorUnit {
    ErrorUnit::ALL.iter().find(|(known, _)| *known == name).map_or_else(ErrorUnit::default, |(_, unit)| *unit)
}

fn cost(name: &str) -> TechniqueCost {
    TechniqueCost::ALL.iter().find(|(known, _)| *known == name).map_or_else(TechniqueCost::default, |(_, cost)| *cost)
}

pub(crate) fn run(arguments: &Arguments, console: &Console) -> Result<()> {
    let outputs = [&arguments.output, &arguments.write, &arguments.json];
    let outputs: Vec<&Path> = outputs.into_iter().flatten().map(PathBuf::as_path).collect();
    check_outputs(&outputs, None)?;
    if let Some(path) = arguments.output.iter().chain(&arguments.write).find(|path| extension(path) != "toml") {
        bail!(WrongUsage(format!("{}: a scene is a file whose name ends in .toml", path.display())));
    }
    if arguments.output.is_some() && corpus_names().contains(&arguments.material.as_str()) {
        bail!(WrongUsage(format!("{}: this map is the lab's own; no scene could name it", arguments.material)));
    }
    let backends = if arguments.backend == TuneBackend::Cpu { Backends::Cpu } else { Backends::Gpu };
    let mut benches = benches(backends, arguments.adapter.as_deref(), console)?;
    let scene = arguments.write.as_deref().map(|path| read_scene(path, arguments.into.as_deref())).transpose()?;
    let names = [arguments.material.clone()];
    let mut materials = load(&names, arguments.size, console)?;
    let (Some(material), Some(bench), true) = (materials.pop(), benches.first_mut(), materials.is_empty()) else {
        bail!(WrongUsage(format!("{}: these are several materials; name one", arguments.material)));
    };
    let width = material.size()[0] as f32;
    let of_scene = scene.as_ref().and_then(|(_, scale)| *scale);
    let height_scale = match (arguments.depth, arguments.height_scale) {
        (Some(depth), _) => depth / width,
        (_, Some(scale)) => scale,
        _ => of_scene.or(material.height_scale).unwrap_or(HEIGHT_SCALE),
    };
    let options = TuneOptions {
        max_error: f64::from(arguments.max_error),
        unit: arguments.unit,
        angle_max: arguments.angle_max,
        depth: height_scale * width,
        cost: arguments.cost,
        rays: arguments.rays,
        ..TuneOptions::default()
    };

    let bar = console.progress(1);
    let progress = |what: &str, done: usize, all: usize| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
        bar.set_message(what.to_owned());
    };
    let tuned = tune(&material, &options, bench, Some(&progress))?;
    bar.finish_and_clear();
    if let Some(path) = &arguments.json {
        write_json(path, &tuned)?;
    }
    let Some(best) = tuned.best() else { bail!("{}", no_technique(&tuned, &options, &material)) };
    let lines = describe(&tuned, best, &options, &material, &bench.name());
    if arguments.json.as_deref() != Some(Path::new("-")) {
        print(format!("{}\n", lines.join("\n")).as_bytes())?;
    }
    let (path, text) = match (&arguments.output, scene) {
        (Some(path), _) => {
            let source = std::iter::once("Made by `relievo tune`.".to_owned());
            let notes: Vec<String> = source.chain(lines).collect();
            (path, new_scene(path, &arguments.material, height_scale, &best.technique, &notes))
        }
        (None, Some((text, _))) => {
            let Some(path) = &arguments.write else { return Ok(()) };
            let edited = edit_scene(&text, arguments.into.as_deref(), &best.technique);
            (path, edited.with_context(|| path.display().to_string())?)
        }
        (None, None) => return Ok(()),
    };
    write_atomic(path, |file| file.write_all(text.as_bytes()))?;
    console.note(&format!("wrote {}", path.display()));
    Ok(())
}

/// The scene's text, and the height scale of the material that is meant, as far as it has one.
fn read_scene(path: &Path, material: Option<&str>) -> Result<(String, Option<f32>)> {
    let scene = Scene::load(path, &LoadOptions { make_size: 16, ..LoadOptions::default() })?;
    let text = std::fs::read_to_string(path).with_context(|| format!("{}: cannot be read", path.display()))?;
    // Refuses a scene that could not be written, before any work is done.
    let any = "exact".parse()?;
    edit_scene(&text, material, &any).with_context(|| path.display().to_string())?;
    let meant = match material {
        Some(name) => scene.materials.iter().find(|candidate| candidate.name == name),
        None => scene.materials.first(),
    };
    let scale = meant.and_then(|material| match material.height {
        HeightRange::Scale(scale) => Some(scale),
        HeightRange::Depth(_) => None,
    });
    Ok((text, scale))
}

/// The error where nothing keeps the largest error.
fn no_technique(tuned: &TuneOutcome, options: &TuneOptions, material: &TestMaterial) -> String {
    let exact = tuned.trial("exact").map_or_else(String::new, |exact| {
        format!("; exact comes nearest by nature, with {:.2e} at {}°", exact.error, exact.angle)
    });
    format!(
        "{}: no technique keeps an error of {} {} up to {}°{exact}; allow more",
        material.name,
        options.max_error,
        options.unit.name(),
        options.angle_max
    )
}

/// Lines on the best technique, and on what it saves.
fn describe(
    tuned: &TuneOutcome,
    best: &Trial,
    options: &TuneOptions,
    material: &TestMaterial,
    machine: &str,
) -> Vec<String> {
    let unit = options.unit.name();
    let mut lines = vec![
        format!(
            "{}, {:.1} texels deep, up to {}° from the normal, error at most {} {unit}: {}",
            material.name, options.depth, options.angle_max, options.max_error, best.technique
        ),
        format!(
            "error {:.3} {unit} at {}°; {:.1} fetches and {:.0} ns per ray, the mean of {} angles, on {machine}",
            best.error,
            best.angle,
            best.fetches.unwrap_or_default(),
            best.ns_per_ray.unwrap_or_default(),
            tuned.angles.len()
        ),
    ];
    for (name, rule) in [("exact", "the default"), ("tutorials", "the tutorials' rule")] {
        let Some(other) = tuned.trial(name) else { continue };
        if other.technique == best.technique {
            lines.push(format!("this is {rule}"));
            continue;
        }
        let saved = |ours: Option<f64>, theirs: Option<f64>| match (ours, theirs) {
            (Some(ours), Some(theirs)) if theirs > 0.0 => {
                let share = (1.0 - ours / theirs) * 100.0;
                if share >= 0.0 { format!("{share:.0} % less") } else { format!("{:.0} % more", -share) }
            }
            _ => "as much".to_owned(),
        };
        let keeps = if other.keeps {
            format!("keeps the error too ({:.3})", other.error)
        } else {
            format!("is off by {:.3} {unit} at {}°", other.error, other.angle)
        };
        lines.push(format!(
            "{} time and {} fetches than {} ({rule}), which {keeps}",
            saved(best.ns_per_ray, other.ns_per_ray),
            saved(best.fetches, other.fetches),
            other.technique
        ));
    }
    lines
}
