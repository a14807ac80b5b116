//! Frame times of every technique at 1280×720, as ratios to `occlusion` with 8 to 32 layers in the same run; the compute path
//! apart. Prints Markdown for `docs/gpu-speed.md` and `docs/exact.md`.
//!
//! ```sh
//! cargo bench -p relievo-gpu --bench frame_times
//! MATERIAL=../shared/textures/ground054 cargo bench -p relievo-gpu --bench frame_times -- --path accuracy
//! cargo bench -p relievo-gpu --bench frame_times -- --rounds 5 --adapter opengl --path compute
//! ```
//!
//! `MATERIAL` is a folder with maps, from the workspace on; without, it is the built-in wall. `--path` is one of `fragment`,
//! `compute`, `accuracy` (image error and time of `exact` and of ever more layers; `--samples` per pixel, `--layers` at most),
//! `tiles` (the coarse pass), `pyramid` (updates of changing heights) and `shells` (silhouettes on curved meshes, on the CPU too);
//! without, the first two.

#![allow(clippy::print_stdout)]

mod accuracy;
mod shells;
mod stage;
mod tiles;
mod updates;

use relievo_gpu::{AdapterChoice, ComputeField, ComputeMarch, Gpu, HeightTexture, Offscreen};
use relievo_gpu::{Renderer, RendererOptions, Tier};
use relievo_map::Wrap;
use relievo_march::{Cones, MarchOptions, Technique};
use stage::{DEGREES, Result, SIZE, Stage, WHOLE, by_rows, milliseconds, rays, summed_up};

/// The rows, and what they change in the scene: without shadows all but the last.
const ROWS: [(&str, &[&str]); 17] = [
    ("`none`", &["technique=none"]),
    ("`normal`", &["technique=normal"]),
    ("`basic`", &["technique=basic"]),
    ("`offset-limiting`", &["technique=offset-limiting"]),
    ("`unity-offset`", &["technique=unity-offset"]),
    ("`steep`", &["technique=steep"]),
    ("`binary`", &["technique=binary"]),
    ("`relief`", &["technique=relief"]),
    ("`occlusion`", &["technique=occlusion"]),
    ("`occlusion` as the tutorials have it: bilinear, no mips", &["technique=occlusion", "filter=linear"]),
    ("`contact`", &["technique=contact"]),
    ("`cone`, relaxed", &["technique=cone"]),
    ("`cone`, conservative", &["technique=cone", "cones=conservative"]),
    ("`exact`", &["technique=exact"]),
    ("`exact`, `hard` shadows", &["technique=exact", "shadow=hard"]),
    ("`exact`, `soft` shadows", &["technique=exact", "shadow=soft"]),
    ("`exact`, `exact` shadows", &["technique=exact", "shadow=exact"]),
];
/// What the others are measured by.
const REFERENCE: usize = 8;

fn fragments(gpu: &Gpu, stage: &Stage, degrees: f32, rounds: usize) -> Result<Vec<(f64, f64)>> {
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let target = Offscreen::new(&gpu.device, &gpu.queue, SIZE, format)?;
    let mut renderers = Vec::new();
    for (_, changes) in ROWS {
        let scene = stage.scene(degrees, changes)?;
        renderers.push(Renderer::new(&gpu.device, &gpu.queue, &scene, format, &RendererOptions::default())?);
    }
    let mut times = Vec::new();
    // The first round is not counted. In every round all techniques follow each other: drift hits them alike.
    for round in 0..=rounds {
        let frames = renderers.iter_mut().map(|renderer| target.time(renderer).map(milliseconds));
        let frames = frames.collect::<std::result::Result<Vec<_>, _>>()?;
        if round > 0 {
            times.push(frames);
        }
    }
    Ok(summed_up(&times, REFERENCE))
}

fn dispatches(gpu: &Gpu, stage: &Stage, degrees: f32, rounds: usize) -> Result<Vec<(f64, f64)>> {
    let texture = HeightTexture::new(&gpu.device, &gpu.queue, &stage.heights()?.with_cones(Cones::default()))?;
    let field = ComputeField { heights: &texture, lod: 0.0, wrap: Wrap::Repeat };
    let rays = rays(degrees, by_rows());
    let mut march = ComputeMarch::new(&gpu.device, &gpu.queue)?;
    let mut times = Vec::new();
    for _ in 0..rounds {
        let mut round = Vec::new();
        for technique in Technique::ALL {
            let taken = march.time(
                field,
                &rays,
                &MarchOptions { technique, bounds: Some(WHOLE), ..MarchOptions::default() },
                1,
            )?;
            // Software adapters put no timestamps around what a compute pass does.
            round.push(taken[0].wall.as_secs_f64() * 1e3);
        }
        times.push(round);
    }
    let reference = Technique::ALL.iter().position(|&technique| technique == Technique::Occlusion);
    Ok(summed_up(&times, reference.ok_or("occlusion is a technique")?))
}

fn table(names: &[String], columns: &[Vec<(f64, f64)>]) {
    println!("| |{}", DEGREES.map(|degrees| format!(" {degrees}° |")).concat());
    println!("|---|{}", "---|".repeat(DEGREES.len()));
    for (k, name) in names.iter().enumerate() {
        let cells = columns.iter().map(|column| format!(" {:.2} ms, ×{:.2} |", column[k].0, column[k].1));
        println!("| {name} |{}", cells.collect::<String>());
    }
    println!();
}

fn main() -> Result<()> {
    let args: Vec<String> = std::env::args().collect();
    let value = |name: &str| args.iter().position(|arg| arg == name).and_then(|k| args.get(k + 1));
    let number = |name: &str, otherwise: u32| value(name).map_or(Ok(otherwise), |value| value.parse::<u32>());
    let rounds = number("--rounds", 15)?.max(1) as usize;
    let name = value("--adapter").map(String::as_str);
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let gpu = pollster::block_on(Gpu::open(&instance, &AdapterChoice { name, ..AdapterChoice::default() }))?;
    let clock = if gpu.tier() == Tier::Full { "the device's timestamps" } else { "the program's clock" };
    let stage = Stage::new()?;
    println!("{}: {}, {}×{}, {rounds} rounds, frames by {clock}.\n", gpu.name(), stage.name()?, SIZE[0], SIZE[1]);

    let path = value("--path").map(String::as_str);
    let computes = gpu.tier().computes();
    if matches!(path, None | Some("fragment")) {
        let columns = DEGREES.map(|degrees| fragments(&gpu, &stage, degrees, rounds));
        let columns = columns.into_iter().collect::<Result<Vec<_>>>()?;
        table(&ROWS.map(|(name, _)| name.to_owned()), &columns);
    }
    if computes && matches!(path, None | Some("compute")) {
        println!("The marches alone, a ray per pixel, as compute kernels, by the program's clock:\n");
        let columns = DEGREES.map(|degrees| dispatches(&gpu, &stage, degrees, rounds));
        let columns = columns.into_iter().collect::<Result<Vec<_>>>()?;
        table(&Technique::ALL.map(|technique| format!("`{}`", technique.name())), &columns);
    }
    match path {
        Some("accuracy") => accuracy::report(&gpu, &stage, rounds, number("--samples", 4)?, number("--layers", 512)?)?,
        Some("tiles") => tiles::report(&gpu, &stage, rounds)?,
        Some("shells") => shells::report(&gpu, rounds)?,
        Some("pyramid") => updates::report(&gpu, &stage, rounds)?,
        _ => {}
    }
    Ok(())
}
