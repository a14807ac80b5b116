use std::time::Instant;

use anyhow::{Context, Result, bail};
use relievo_cpu::{RenderOptions, Renderer};

use super::draw_job::{DrawJob, Drawn, Times};
use crate::console::{Console, milliseconds};

/// Draws on all threads there are, or were asked for. `why` goes on from the sentence that says so.
pub(crate) fn draw(job: &DrawJob<'_>, why: &str, console: &Console) -> Result<Drawn> {
    let start = Instant::now();
    let renderer = Renderer::new(job.scene).with_context(|| job.name.clone())?;
    let build_ms = milliseconds(start);

    let (threads, count) = job.threads;
    let adapter = format!("CPU with {count} {}", if count == 1 { "thread" } else { "threads" });
    console.note(&format!("drawing on the {adapter}{why}"));
    let bar = console.progress(u64::from(job.frames) * u64::from(job.scene.image.height));
    bar.set_message("drawing");
    let progress = |_: u32, _: u32| bar.inc(1);
    let options = RenderOptions { threads, progress: Some(&progress), ..RenderOptions::default() };
    let mut wall = Vec::new();
    let mut last = None;
    for _ in 0..job.frames {
        let start = Instant::now();
        last = Some(renderer.render(&options)?);
        wall.push(milliseconds(start));
    }
    bar.finish_and_clear();
    let Some(frame) = last else { bail!("no frame was drawn; --frames must be at least 1") };
    Ok(Drawn {
        backend: "cpu",
        adapter,
        pixels: frame.pixels,
        aovs: Some(frame.aovs),
        triangles: renderer.triangles(),
        build_ms,
        times: Times { gpu: None, wall },
    })
}
