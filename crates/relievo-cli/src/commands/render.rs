use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Result, bail};
use clap::{Args, ValueEnum};
use relievo_cpu::{RenderOptions, Renderer};
use relievo_map::write_atomic;
use relievo_scene::SurfaceTechnique;

use crate::aov::AovFile;
use crate::console::Console;
use crate::memory::peak_bytes;
use crate::picture::{check_folder, check_picture_path, write_picture};
use crate::scene_args::{SceneArguments, technique_parser};
use crate::stats::{FrameTimes, Stats, march_costs};

/// Draw a scene into a PNG
#[derive(Args)]
#[command(after_help = "Examples:
  relievo render -o wall.png
  relievo render scenes/sphere.toml -o sphere.png --technique occlusion --size 1280x720
  relievo render -o wall.png --set lights.0.position='[1, 1, 0.3]' --aov depth=depth.exr --stats stats.json")]
pub(crate) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// The picture (PNG)
    #[arg(long, short, value_name = "OUT.png")]
    output: PathBuf,
    /// Where to draw: auto takes a GPU if there is a real one, else the CPU
    #[arg(long, value_enum, default_value_t = Backend::Auto)]
    backend: Backend,
    /// How every material's relief is drawn
    #[arg(long, value_name = "TECHNIQUE", value_parser = technique_parser())]
    technique: Option<SurfaceTechnique>,
    /// Write more than the picture: depth, normal, uv, fetches, shadow or hit, as .exr (the numbers) or .png (to look at); may be repeated
    #[arg(long = "aov", value_name = "KIND=FILE")]
    aovs: Vec<AovFile>,
    /// Write timings and costs as JSON
    #[arg(long, value_name = "FILE.json")]
    stats: Option<PathBuf>,
    /// Draw this many times, for the timings
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    frames: u32,
}

#[derive(Clone, Copy, ValueEnum)]
enum Backend {
    Auto,
    Cpu,
    Gpu,
}

pub(crate) fn run(arguments: &Arguments, console: &Console) -> Result<()> {
    check_picture_path(&arguments.output)?;
    arguments.aovs.iter().try_for_each(AovFile::check)?;
    arguments.stats.as_deref().map_or(Ok(()), check_folder)?;
    let threads = arguments.scene.thread_count();
    match arguments.backend {
        Backend::Gpu => bail!("this build draws on the CPU only; use --backend cpu or --backend auto"),
        Backend::Auto => {
            console.note(&format!("drawing on the CPU with {threads} threads: this build has no GPU backend"));
        }
        Backend::Cpu => console.note(&format!("drawing on the CPU with {threads} threads, as asked")),
    }

    let start = Instant::now();
    let mut scene = arguments.scene.load(console)?;
    if let Some(technique) = arguments.technique {
        for material in &mut scene.materials {
            material.relief.technique = technique;
        }
    }
    let load_ms = milliseconds(start);

    let start = Instant::now();
    let renderer = Renderer::new(&scene)?;
    let build_ms = milliseconds(start);

    let bar = console.progress(u64::from(arguments.frames) * u64::from(scene.image.height));
    bar.set_message("drawing");
    let progress = |_: u32, _: u32| bar.inc(1);
    let options =
        RenderOptions { threads: arguments.scene.threads, progress: Some(&progress), ..RenderOptions::default() };
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
            adapter: format!("CPU, {threads} threads"),
            technique: techniques.join(", "),
            width: scene.image.width,
            height: scene.image.height,
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
        let json = serde_json::to_string_pretty(&stats)?;
        write_atomic(path, |file| writeln!(file, "{json}"))?;
    }
    Ok(())
}

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}
