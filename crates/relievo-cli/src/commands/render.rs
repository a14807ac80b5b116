//! `relievo render`.

mod animate;
mod frame_files;

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Result, bail};
use clap::Args;
use relievo_map::{FilmShape, write_picture};
use relievo_scene::{Scene, SurfaceTechnique};

use crate::aov::AovFile;
use crate::backend::{Backend, Device, DrawJob};
use crate::console::{Console, WrongUsage, milliseconds};
use crate::memory::{check_room, peak_bytes};
use crate::outputs::{check_outputs, extension, film_parser, write_json};
use animate::TimeRange;
use crate::scene_args::{MACHINE, OUTPUT, SCENE, SceneArguments, technique_parser, whole_number};
use crate::stats::{Stats, march_costs};

/// Memory for a pixel while it is drawn, with all that is kept for AOVs, in bytes (measured: 110).
const BYTES_PER_PIXEL: u64 = 128;

/// Draw a scene into a PNG, or its course over time into many, or into one film
#[derive(Args)]
#[command(after_help = "Examples:
  relievo render -o wall.png
  relievo render scenes/sphere.toml -o sphere.png --technique occlusion --size 1280x720
  relievo render -o wall.png --aov depth=depth.exr --aov fetches=cost.png --stats stats.json
  relievo render -o wall.png --set lights.0.direction='[0.7, -0.5, -0.5]' --shadow soft
  relievo render scenes/drifting-clouds.toml --time 2.5 -o clouds.png
  relievo render scenes/drifting-clouds.toml --animate 0..8 --fps 24 -o frames/%04d.png
  relievo render scenes/drifting-clouds.toml --animate 0..8 --fps 24 -o clouds.webp")]
pub(crate) struct Arguments {
    /// The picture (PNG); with --animate a name with %d in it for each frame's number, or a film: .apng or .webp
    #[arg(long, short, value_name = "OUT.png", value_parser = film_parser(), help_heading = OUTPUT)]
    output: PathBuf,
    /// More than colours: depth, normal, uv, fetches, shadow or hit, as .exr (the numbers) or .png (to look at); may be repeated
    #[arg(long = "aov", value_name = "KIND=FILE", help_heading = OUTPUT)]
    aovs: Vec<AovFile>,
    /// Timings and costs as JSON; - for stdout
    #[arg(long, value_name = "FILE.json", help_heading = OUTPUT)]
    stats: Option<PathBuf>,
    #[command(flatten)]
    scene: SceneArguments,
    /// Draw every frame from time A to before time B, seconds; frames that an earlier run has drawn are left alone
    #[arg(long, value_name = "A..B", allow_hyphen_values = true, conflicts_with_all = ["time", "aovs", "stats", "frames"], help_heading = SCENE)]
    animate: Option<TimeRange>,
    /// Frames per second of --animate
    #[arg(long, value_name = "N", default_value_t = 30.0, value_parser = parse_rate, allow_negative_numbers = true, requires = "animate", help_heading = SCENE)]
    fps: f64,
    /// Technique of every material's relief [default: the scene's]
    #[arg(long, value_name = "TECHNIQUE", value_parser = technique_parser(), help_heading = SCENE)]
    technique: Option<SurfaceTechnique>,
    /// Backend that draws: auto takes a GPU if there is a real one, else the CPU
    #[arg(long, value_enum, default_value_t = Backend::Auto, help_heading = MACHINE)]
    backend: Backend,
    /// The GPU to draw on, by a part of its name as `relievo devices` lists it
    #[arg(long, value_name = "NAME", help_heading = MACHINE)]
    adapter: Option<String>,
    /// Draw this many times, for the timings (on a GPU after some frames that are not counted)
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = whole_number(1, 1_000_000), allow_negative_numbers = true, help_heading = MACHINE)]
    frames: u32,
}

impl Arguments {
    /// Makes the changes that the command line asks for.
    fn prepare(&self, scene: &mut Scene) {
        self.scene.prepare(scene);
        if let Some(technique) = self.technique {
            for material in &mut scene.materials {
                material.relief.technique = technique;
            }
        }
    }
}

fn parse_rate(text: &str) -> Result<f64, String> {
    let rate = text.trim().parse().ok().filter(|rate: &f64| *rate > 0.0 && *rate <= FilmShape::MAX_RATE);
    rate.ok_or_else(|| format!("expected frames per second, above 0 and at most {}, as in 30", FilmShape::MAX_RATE))
}

pub(crate) fn run(arguments: &Arguments, console: &Console) -> Result<()> {
    if let Some(range) = arguments.animate {
        return animate::run(arguments, range, console);
    }
    if extension(&arguments.output) != "png" {
        let name = arguments.output.display();
        bail!(WrongUsage(format!("{name}: a film shows a time; say which with --animate, as in --animate 0..4")));
    }
    let outputs: Vec<&Path> = std::iter::once(arguments.output.as_path())
        .chain(arguments.aovs.iter().map(AovFile::path))
        .chain(arguments.stats.as_deref())
        .collect();
    check_outputs(&outputs, arguments.scene.path())?;
    let device = Device::choose(arguments.backend, arguments.adapter.as_deref())?;

    let start = Instant::now();
    let mut scene = arguments.scene.load(console)?;
    arguments.prepare(&mut scene);
    let load_ms = milliseconds(start);
    for note in scene.notes_on_unseen_reliefs() {
        console.note(&note);
    }
    let (width, height) = (scene.image.width, scene.image.height);
    check_room(
        u64::from(width) * u64::from(height) * BYTES_PER_PIXEL,
        &format!("pictures of {width}×{height} pixels"),
        "a smaller --size",
    )?;

    let job = DrawJob {
        scene: &scene,
        name: arguments.scene.name(),
        threads: (arguments.scene.threads(), arguments.scene.thread_count()),
        frames: arguments.frames,
        timed: arguments.stats.is_some(),
        measured: arguments.stats.is_some() || !arguments.aovs.is_empty(),
    };
    let drawn = device.draw(&job, console)?;

    write_picture(&arguments.output, &drawn.pixels)?;
    let Some(aovs) = &drawn.aovs else { return Ok(()) };
    for aov in &arguments.aovs {
        aov.write(aovs)?;
    }
    if let Some(path) = &arguments.stats {
        let mut techniques: Vec<&str> =
            scene.objects.iter().map(|object| scene.materials[object.material].relief.technique.name()).collect();
        techniques.sort_unstable();
        techniques.dedup();
        let (hit_pixels, fetches, iterations) = march_costs(aovs);
        let stats = Stats {
            backend: drawn.backend,
            adapter: drawn.adapter,
            technique: techniques.join(", "),
            width,
            height,
            samples: scene.image.samples,
            frames: drawn.times.wall.len(),
            times: (&drawn.times).into(),
            hit_pixels,
            fetches,
            iterations,
            triangles: drawn.triangles,
            load_ms,
            build_ms: drawn.build_ms,
            peak_bytes: peak_bytes(),
        };
        write_json(path, &stats)?;
    }
    Ok(())
}
