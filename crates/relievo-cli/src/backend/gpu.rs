use std::time::Instant;

use anyhow::{Context, Error, Result};
use pollster::block_on;
use relievo_gpu::{AdapterChoice, GpuError, Offscreen, Renderer, RendererOptions, is_real};

pub(crate) use relievo_gpu::Gpu;

use super::draw_job::{DrawJob, Drawn, Times};
use super::film_job::{Emit, FilmJob};
use crate::console::{Console, milliseconds};

/// Frames before those that are timed: the first ones wait for shaders and memory.
const WARM_UP: u32 = 3;

fn instance() -> wgpu::Instance {
    wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env())
}

/// All adapters, the likely fastest first.
pub(crate) fn adapters() -> Result<Vec<wgpu::Adapter>> {
    Ok(block_on(relievo_gpu::adapters(&instance())))
}

/// The adapter with this in its name, or the likely fastest.
pub(crate) fn open(name: Option<&str>) -> Result<Gpu> {
    let opened = block_on(Gpu::open(&instance(), &AdapterChoice { name, ..AdapterChoice::default() }));
    opened.map_err(|error| match error {
        GpuError::NoAdapter => Error::msg(format!("{error} (--backend cpu)")),
        GpuError::NoSuchAdapter { .. } => Error::msg(format!("--adapter: {error}")),
        other => other.into(),
    })
}

/// The likely fastest adapter that is not the CPU in disguise; or why there is none.
pub(crate) fn open_real() -> Result<Gpu, String> {
    let adapters = block_on(relievo_gpu::adapters(&instance()));
    let mut names: Vec<String> = adapters.iter().map(|adapter| adapter.get_info().name).collect();
    names.dedup();
    match adapters.into_iter().find(|adapter| is_real(&adapter.get_info())) {
        Some(adapter) => block_on(Gpu::on(adapter)).map_err(|error| error.to_string()),
        None if names.is_empty() => Err("there is no GPU adapter".to_owned()),
        None => Err(format!("there is no real GPU, only {}", names.join(" and "))),
    }
}

/// The device as the lab measures it.
pub(crate) fn bench(gpu: &Gpu) -> Result<relievo_lab::MarchBackend> {
    Ok(relievo_lab::MarchBackend::gpu(gpu)?)
}

/// Name of the device.
pub(crate) fn name(gpu: &Gpu) -> String {
    gpu.name()
}

/// An animation that a device draws.
pub(crate) struct GpuFilm<'a> {
    job: &'a FilmJob<'a>,
    renderer: Renderer,
    offscreen: Offscreen,
}

/// Makes an animation ready. `why` goes on from the sentence that says so.
pub(crate) fn film<'a>(gpu: &Gpu, job: &'a FilmJob<'a>, why: &str, console: &Console) -> Result<GpuFilm<'a>> {
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let size = [job.first.image.width, job.first.image.height];
    let offscreen = Offscreen::new(&gpu.device, &gpu.queue, size, format)?;
    let renderer = Renderer::new(&gpu.device, &gpu.queue, job.first, format, &RendererOptions::default())
        .with_context(|| job.name.clone())?;
    console.note(&format!("drawing on {}{why}", gpu.name()));
    for note in renderer.notes() {
        console.note(&note);
    }
    Ok(GpuFilm { job, renderer, offscreen })
}

impl GpuFilm<'_> {
    pub(crate) fn draw(&mut self, frames: &[usize], emit: Emit<'_>) -> Result<()> {
        for &frame in frames {
            let scene = self.job.scene(frame, true)?;
            self.renderer.set_scene(&scene).with_context(|| self.job.name.clone())?;
            self.offscreen.draw(&mut self.renderer)?;
            emit(frame, self.offscreen.pixels()?)?;
        }
        Ok(())
    }
}

/// Draws on this device. `why` goes on from the sentence that says so.
pub(crate) fn draw(gpu: &Gpu, job: &DrawJob<'_>, why: &str, console: &Console) -> Result<Drawn> {
    let size = [job.scene.image.width, job.scene.image.height];
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let start = Instant::now();
    let offscreen = Offscreen::new(&gpu.device, &gpu.queue, size, format)?;
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue, job.scene, format, &RendererOptions::default())
        .with_context(|| job.name.clone())?;
    let build_ms = milliseconds(start);

    console.note(&format!("drawing on {}{why}", gpu.name()));
    for note in renderer.notes() {
        console.note(&note);
    }
    let warm_up = if job.timed { WARM_UP } else { 0 };
    let bar = console.progress(u64::from(warm_up + job.frames));
    bar.set_message("drawing");
    let mut times = Vec::new();
    for number in 0..warm_up + job.frames {
        let time = offscreen.time(&mut renderer)?;
        if number >= warm_up {
            times.push(time);
        }
        bar.inc(1);
    }
    let pixels = offscreen.pixels()?;
    let aovs = if job.measured { Some(renderer.measure(size)?) } else { None };
    bar.finish_and_clear();
    Ok(Drawn {
        backend: "gpu",
        adapter: gpu.name(),
        pixels,
        aovs,
        triangles: renderer.triangles(),
        build_ms,
        times: Times {
            gpu: times.iter().map(|time| Some(time.gpu?.as_secs_f64() * 1e3)).collect(),
            wall: times.iter().map(|time| time.wall.as_secs_f64() * 1e3).collect(),
        },
    })
}
