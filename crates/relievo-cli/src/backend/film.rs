//! Drawing the frames of an animation: several at a time on the CPU, one after the other on a GPU.

use std::sync::Mutex;
use std::sync::PoisonError;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use anyhow::{Context, Error, Result};
use relievo_cpu::{RenderOptions, Renderer};
use relievo_map::Grid;

use super::film_job::{Emit, FilmJob};
use super::gpu;

/// An animation that is being drawn.
pub(crate) enum Film<'a> {
    Cpu(Box<CpuFilm<'a>>),
    Gpu(Box<gpu::GpuFilm<'a>>),
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
