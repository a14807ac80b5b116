//! Frame times of every technique on the built-in wall at 1280×720, as ratios to `occlusion` with 8 to 32 layers in the same
//! run; the compute path apart. Prints Markdown for `docs/gpu-speed.md`.
//!
//! ```sh
//! cargo bench -p relievo-gpu --bench frame_times
//! cargo bench -p relievo-gpu --bench frame_times -- --rounds 5 --adapter opengl --path compute
//! ```

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::path::Path;

use glam::{Vec2, Vec3};
use relievo_gpu::{AdapterChoice, ComputeField, ComputeMarch, FrameTime, Gpu, HeightTexture, Offscreen};
use relievo_gpu::{Renderer, RendererOptions, Tier};
use relievo_map::Wrap;
use relievo_march::{Bounds, Cones, Heights, March, Ray, Technique};
use relievo_scene::{LoadOptions, Scene};

const SIZE: [u32; 2] = [1280, 720];
const DEGREES: [f32; 3] = [0.0, 60.0, 80.0];
/// A long lens: the angle is nearly the same all over the picture.
const VERTICAL_FOV: f32 = 8.0;
/// As in the wall's scene.
const DEPTH: f32 = 0.055;
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

/// Where the camera stands, `degrees` from the normal, so that the wall just fills the picture.
fn eye(degrees: f32) -> Vec3 {
    let towards = Vec3::new(0.0, -degrees.to_radians().sin(), degrees.to_radians().cos());
    // What is seen grows with the distance: from one unit away, how far does it reach?
    let corners = [Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0), Vec2::new(-1.0, 1.0), Vec2::new(1.0, 1.0)];
    let reach = corners.map(|corner| on_wall(towards, corner).0.truncate().abs().max_element());
    towards * (0.96 / reach.into_iter().fold(0.0, f32::max))
}

/// Where the view through a place of the picture (−1..1, up) meets the wall, and its direction.
fn on_wall(eye: Vec3, place: Vec2) -> (Vec3, Vec3) {
    let forward = -eye.normalize();
    let right = forward.cross(Vec3::Y).normalize();
    let half = (VERTICAL_FOV.to_radians() * 0.5).tan();
    let aspect = SIZE[0] as f32 / SIZE[1] as f32;
    let direction = (forward + right * (place.x * half * aspect) + right.cross(forward) * (place.y * half)).normalize();
    (eye - direction * (eye.z / direction.z), direction)
}

fn scene(degrees: f32, changes: &[&str]) -> Result<Scene, Box<dyn Error>> {
    let Vec3 { x, y, z } = eye(degrees);
    let mut overrides = vec![
        format!("camera.position=[{x}, {y}, {z}]"),
        "camera.target=[0, 0, 0]".to_owned(),
        format!("camera.vertical_fov={VERTICAL_FOV}"),
        "materials.wall.filter=trilinear".to_owned(),
        "materials.wall.relief.shadow=none".to_owned(),
    ];
    overrides.extend(changes.iter().map(|change| match change.starts_with("filter") {
        true => format!("materials.wall.{change}"),
        false => format!("materials.wall.relief.{change}"),
    }));
    let overrides = overrides.iter().map(|change| change.parse()).collect::<Result<_, _>>()?;
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/wall.toml");
    Ok(Scene::load(&path, &LoadOptions { overrides, ..LoadOptions::default() })?)
}

fn milliseconds(time: FrameTime) -> f64 {
    time.gpu.unwrap_or(time.wall).as_secs_f64() * 1e3
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values[values.len() / 2]
}

/// For every row: the median, and the median of the ratios to the reference of the same round.
fn summed_up(rounds: &[Vec<f64>], reference: usize) -> Vec<(f64, f64)> {
    let row = |k: usize| {
        let ratios = rounds.iter().map(|round| round[k] / round[reference]).collect();
        (median(rounds.iter().map(|round| round[k]).collect()), median(ratios))
    };
    (0..rounds[0].len()).map(row).collect()
}

fn fragments(gpu: &Gpu, degrees: f32, rounds: usize) -> Result<Vec<(f64, f64)>, Box<dyn Error>> {
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let target = Offscreen::new(&gpu.device, &gpu.queue, SIZE, format)?;
    let mut renderers = Vec::new();
    for (_, changes) in ROWS {
        let scene = scene(degrees, changes)?;
        renderers.push(Renderer::new(&gpu.device, &gpu.queue, &scene, format, &RendererOptions::default())?);
    }
    let mut times = Vec::new();
    // The first round is not counted. In every round all techniques follow each other: drift hits them alike.
    for round in 0..=rounds {
        let frames = renderers.iter_mut().map(|renderer| target.time(renderer).map(milliseconds));
        let frames = frames.collect::<Result<Vec<_>, _>>()?;
        if round > 0 {
            times.push(frames);
        }
    }
    Ok(summed_up(&times, REFERENCE))
}

fn dispatches(gpu: &Gpu, degrees: f32, rounds: usize) -> Result<Vec<(f64, f64)>, Box<dyn Error>> {
    let wall = scene(degrees, &[])?;
    let heights = Heights::new(wall.materials[0].maps.height.as_ref().ok_or("the wall has heights")?);
    let heights = heights.with_cones(Cones::default());
    let texture = HeightTexture::new(&gpu.device, &gpu.queue, &heights)?;
    let field = ComputeField { heights: &texture, lod: 0.0, wrap: Wrap::Repeat };
    let eye = eye(degrees);
    let ray = |i: u32| {
        let at = |i: u32, n: u32| (i as f32 + 0.5) / n as f32 * 2.0 - 1.0;
        let (place, direction) = on_wall(eye, Vec2::new(at(i % SIZE[0], SIZE[0]), -at(i / SIZE[0], SIZE[1])));
        Ray::from_view([0.5 + 0.5 * place.x, 0.5 - 0.5 * place.y], (-direction).into(), [DEPTH, -DEPTH])
    };
    let rays: Vec<Ray> = (0..SIZE[0] * SIZE[1]).map(ray).collect();
    let mut march = ComputeMarch::new(&gpu.device, &gpu.queue)?;
    let mut times = Vec::new();
    for _ in 0..rounds {
        let mut round = Vec::new();
        for technique in Technique::ALL {
            let bounds = Some(Bounds { min: [0.0; 2], max: [1.0; 2] });
            let taken = march.time(field, &rays, &March { technique, bounds, ..March::default() }, 1)?;
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

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().collect();
    let value = |name: &str| args.iter().position(|arg| arg == name).and_then(|k| args.get(k + 1));
    let rounds = value("--rounds").map_or(Ok(15), |rounds| rounds.parse::<usize>())?.max(1);
    let name = value("--adapter").map(String::as_str);
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let gpu = pollster::block_on(Gpu::open(&instance, &AdapterChoice { name, ..AdapterChoice::default() }))?;
    let clock = if gpu.tier() == Tier::Full { "the device's timestamps" } else { "the program's clock" };
    println!("{}: {}×{}, median of {rounds} frames by {clock}.\n", gpu.name(), SIZE[0], SIZE[1]);

    let wanted = |path: &str| value("--path").is_none_or(|only| only == path);
    if wanted("fragment") {
        let columns = DEGREES.iter().map(|&degrees| fragments(&gpu, degrees, rounds)).collect::<Result<Vec<_>, _>>()?;
        table(&ROWS.map(|(name, _)| name.to_owned()), &columns);
    }
    if wanted("compute") && gpu.tier().computes() {
        println!("The marches alone, a ray per pixel, as compute kernels, by the program's clock:\n");
        let columns =
            DEGREES.iter().map(|&degrees| dispatches(&gpu, degrees, rounds)).collect::<Result<Vec<_>, _>>()?;
        table(&Technique::ALL.map(|technique| format!("`{}`", technique.name())), &columns);
    }
    Ok(())
}
