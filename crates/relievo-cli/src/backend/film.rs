//! Drawing the frames of an animation: several at a time on the CPU, one after the other on a GPU.

use std::sync::Mutex;
use std::sync::PoisonError;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use anyhow::{Context, Error, Result};
use relievo_cpu::{RenderOptions, Renderer};
use relievo_map::Grid;
use relievo_scene::{AnimatedScene, Scene, SceneTime};

use super::gpu;

/// An animation to draw.
pub(crate) struct FilmJob<'a> {
    pub(crate) film: &'a AnimatedScene,
    /// The scene of the first frame.
    pub(crate) first: &'a Scene,
    /// Makes the changes that the command line asks for.
    pub(crate) prepare: &'a (dyn Fn(&mut Scene) + Sync),
    pub(crate) times: &'a [SceneTime],
    /// Name of the scene in errors.
    pub(crate) name: String,
    /// Threads of the CPU.
    pub(crate) threads: usize,
}

impl FilmJob<'_> {
    /// The scene of a frame; for a device that makes heights they are not made here.
    pub(crate) fn scene(&self, frame: usize, heights_later: bool) -> Result<Scene> {
        let time = self.times[frame];
        let scene = if heights_later { self.film.at_without_heights(time) } else { self.film.at(time) };
        let mut scene = scene.with_context(|| format!("at {time}"))?;
        (self.prepare)(&mut scene);
        Ok(scene)
    }
}

/// Takes a finished frame: its number and its pixels. Called from any thread.
pub(crate) type Emit<'a> = &'a (dyn Fn(usize, Grid<[u8; 3]>) -> Result<()> + Sync);

/// An animation that is being drawn.
pub(crate) enum Film<'a> {
    Cpu(CpuFilm<'a>),
    Gpu(gpu::GpuFilm<'a>),
}

impl Film<'_> {
    /// Frames that are best drawn at a time.
    pub(crate) fn frames_at_a_time(&self) -> usize {
        match self {
            Self::Cpu(film) => 2 * film.job.threads,
            Self::Gpu(_) => 1,
        }
    }

    /// Draws these frames. Those that are finished when one fails have been emitted.
    pub(crate) fn draw(&mut self, frames: &[usize], emit: Emit<'_>) -> Result<()> {
        match self {
            Self::Cpu(film) => film.draw(frames, emit),
            Self::Gpu(film) => film.draw(frames, emit),
        }
    }
}

/// An animation that the CPU draws: each frame shares with the first one what is the same.
pub(crate) struct CpuFilm<'a> {
    job: &'a FilmJob<'a>,
    first: Renderer,
}

impl<'a> CpuFilm<'a> {
    pub(super) fn new(job: &'a FilmJob<'a>) -> Result<Self> {
        Ok(Self { job, first: Renderer::new(job.first).with_context(|| job.name.clone())? })
    }

    fn draw(&self, frames: &[usize], emit: Emit<'_>) -> Result<()> {
        let workers = self.job.threads.min(frames.len()).max(1);
        // Where there are more threads than frames, each frame has several.
        let threads = (self.job.threads / workers).max(1);
        let (next, failure) = (AtomicUsize::new(0), Mutex::new(None::<(usize, Error)>));
        let work = || {
            while let Some(&frame) = frames.get(next.fetch_add(1, Ordering::Relaxed)) {
                if let Err(error) = self.frame(frame, threads).and_then(|pixels| emit(frame, pixels)) {
                    // The others finish what they have begun; the first frame's error counts.
                    next.store(frames.len(), Ordering::Relaxed);
                    let mut failure = failure.lock().unwrap_or_else(PoisonError::into_inner);
                    if failure.as_ref().is_none_or(|(other, _)| frame < *other) {
                        *failure = Some((frame, error));
                    }
                }
            }
        };
        thread::scope(|scope| {
            for _ in 1..workers {
                // Where threads cannot be had, this one does all the work.
                if thread::Builder::new().spawn_scoped(scope, work).is_err() {
                    break;
                }
            }
            work();
        });
        failure.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(Ok(()), |(_, error)| Err(error))
    }

    fn frame(&self, frame: usize, threads: usize) -> Result<Grid<[u8; 3]>> {
        let scene = self.job.scene(frame, false)?;
        let renderer = self.first.for_scene(&scene).with_context(|| self.job.name.clone())?;
        let options = RenderOptions { threads: Some(threads), ..RenderOptions::default() };
        Ok(renderer.render(&options)?.pixels)
    }
}
