use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result, bail};
use clap::{Args, ValueEnum};
use relievo_cpu::{RenderOptions, Renderer};
use relievo_map::write_picture;
use relievo_scene::SurfaceTechnique;

use crate::aov::AovFile;
use crate::console::Console;
use crate::memory::{check_room, peak_bytes};
use crate::outputs::{check_outputs, picture_parser, write_json};
use crate::scene_args::{MACHINE, OUTPUT, SCENE, SceneArguments, technique_parser, whole_number};
use crate::stats::{FrameTimes, Stats, march_costs};

/// What a pixel takes while it is drawn, with all that is kept for AOVs (measured: 110).
const BYTES_PER_PIXEL: u64 = 128;

/// Draw a scene into a PNG
#[derive(Args)]
#[command(after_help = "Examples:
  relievo render -o wall.png
  relievo render scenes/sphere.toml -o sphere.png --technique occlusion --size 1280x720
  relievo render -o wall.png --aov depth=depth.exr --aov fetches=cost.png --stats stats.json
  relievo render -o wall.png --set lights.0.direction='[0.7, -0.5, -0.5]' --shadow soft")]
pub(crate) struct Arguments {
    /// The picture (PNG)
    #[arg(long, short, value_name = "OUT.png", value_parser = picture_parser(), help_heading = OUTPUT)]
    output: PathBuf,
    /// More than colours: depth, normal, uv, fetches, shadow or hit, as .exr (the numbers) or .png (to look at); may be repeated
    #[arg(long = "aov", value_name = "KIND=FILE", help_heading = OUTPUT)]
    aovs: Vec<AovFile>,
    /// Timings and costs as JSON; - for stdout
    #[arg(long, value_name = "FILE.json", help_heading = OUTPUT)]
    stats: Option<PathBuf>,
    #[command(flatten)]
    scene: SceneArguments,
    /// How every material's relief is drawn [default: the scene's]
    #[arg(long, value_name = "TECHNIQUE", value_parser = technique_parser(), help_heading = SCENE)]
    technique: Option<SurfaceTechnique>,
    /// Where to draw: auto takes a GPU if there is a real one, else the CPU
    #[arg(long, value_enum, default_value_t = Backend::Auto, help_heading = MACHINE)]
    backend: Backend,
    /// Draw this many times, for the timings
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = whole_number(1, 1_000_000), allow_negative_numbers = true, help_heading = MACHINE)]
    frames: u32,
}

#[derive(Clone, Copy, ValueEnum)]
enum Backend {
    Auto,
    Cpu,
    Gpu,
}

pub(crate) fn run(arguments: &Arguments, console: &Console) -> Result<()> {
    let outputs: Vec<&Path> = std::iter::once(arguments.output.as_path())
        .chain(arguments.aovs.iter().map(AovFile::path))
        .chain(arguments.stats.as_deref())
        .collect();
    check_outputs(&outputs, arguments.scene.path())?;
    let threads = arguments.scene.thread_count();
    let why = match arguments.backend {
        Backend::Gpu => bail!("--backend gpu: this build has no GPU backend; use --backend cpu or --backend auto"),
        Backend::Auto => ": this build has no GPU backend",
        Backend::Cpu => ", as asked",
    };

    let start = Instant::now();
    let mut scene = arguments.scene.load(console)?;
    if let Some(technique) = arguments.technique {
        for material in &mut scene.materials {
            material.relief.technique = technique;
        }
    }
    let load_ms = milliseconds(start);
    let (width, height) = (scene.image.width, scene.image.height);
    check_room(
        u64::from(width) * u64::from(height) * BYTES_PER_PIXEL,
        &format!("pictures of {width}×{height} pixels"),
        "a smaller --size",
    )?;

    let start = Instant::now();
    let renderer = Renderer::new(&scene).with_context(|| arguments.scene.name())?;
    let build_ms = milliseconds(start);

    console.note(&format!("drawing on the {}{why}", cpu(threads)));
    let bar = console.progress(u64::from(arguments.frames) * u64::from(scene.image.height));
    bar.set_message("drawing");
    let progress = |_: u32, _: u32| bar.inc(1);
    let options =
        RenderOptions { threads: arguments.scene.threads(), progress: Some(&progress), ..RenderOptions::default() };
    let mut times = Vec::new();
    let mut last = None;
    for _ in 0..arguments.frames {
        let start = Instant::now();
        last = Some(renderer.render(&options)?);
        times.push(milliseconds(start));
    }
    bar.finish_and_clear();
    let Some(frame) = last else { bail!("no frame was drawn; --frames must be at least 1") };

    write_picture(&arguments.output, &frame.pixels)?;
    for aov in &arguments.aovs {
        aov.write(&frame)?;
    }
    if let Some(path) = &arguments.stats {
        let mut techniques: Vec<&str> =
            scene.objects.iter().map(|object| scene.materials[object.material].relief.technique.name()).collect();
        techniques.sort_unstable();
        techniques.dedup();
        let (hit_pixels, fetches, iterations) = march_costs(&frame);
        let stats = Stats {
            backend: "cpu",
            adapter: cpu(threads),
            technique: techniques.join(", "),
            width,
            height,
            samples: scene.image.samples,
            frames: times.len(),
            frame_ms: FrameTimes::of(&times),
            hit_pixels,
            fetches,
            iterations,
            triangles: renderer.triangles(),
            load_ms,
            build_ms,
            peak_bytes: peak_bytes(),
        };
        write_json(path, &stats)?;
    }
    Ok(())
}

fn cpu(threads: usize) -> String {
    format!("CPU with {threads} {}", if threads == 1 { "thread" } else { "threads" })
}

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}
