//! Drawing a scene on the CPU or on a GPU, with the same result.

use anyhow::{Result, bail};
use clap::ValueEnum;

use crate::console::{Console, WrongUsage, with_causes};

mod cpu;
mod draw_job;
mod film;
mod film_job;
#[cfg(feature = "gpu")]
pub(crate) mod gpu;
#[cfg(not(feature = "gpu"))]
#[path = "backend/no_gpu.rs"]
pub(crate) mod gpu;

use draw_job::Drawn;
pub(crate) use draw_job::{DrawJob, Times};
pub(crate) use film::Film;
pub(crate) use film_job::FilmJob;

/// The backend that draws.
#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum Backend {
    Auto,
    Cpu,
    Gpu,
}

/// The device that draws, with the reason for the choice.
pub(crate) enum Device {
    Cpu {
        why: String,
    },
    Gpu {
        gpu: gpu::Gpu,
        why: &'static str,
        /// True if the CPU may take over.
        replaceable: bool,
    },
}

impl Device {
    /// The device that was asked for.
    pub(crate) fn choose(backend: Backend, adapter: Option<&str>) -> Result<Self> {
        match (backend, adapter) {
            (Backend::Cpu, Some(_)) => {
                let text = "--adapter names a GPU, but --backend cpu draws without one; leave one of the two out";
                bail!(WrongUsage(text.to_owned()))
            }
            (Backend::Cpu, None) => Ok(Self::Cpu { why: ", as asked".to_owned() }),
            (Backend::Gpu, _) | (Backend::Auto, Some(_)) => {
                Ok(Self::Gpu { gpu: gpu::open(adapter)?, why: ", as asked", replaceable: false })
            }
            (Backend::Auto, None) => Ok(match gpu::open_real() {
                Ok(gpu) => Self::Gpu { gpu, why: ", a real GPU", replaceable: true },
                Err(reason) => Self::Cpu { why: format!(": {reason}") },
            }),
        }
    }

    /// Name of the device, for what depends on it.
    pub(crate) fn name(&self) -> String {
        match self {
            Self::Cpu { .. } => "cpu".to_owned(),
            Self::Gpu { gpu, .. } => gpu::name(gpu),
        }
    }

    /// Makes an animation ready.
    pub(crate) fn film<'a>(&self, job: &'a FilmJob<'a>, console: &Console) -> Result<Film<'a>> {
        let on_cpu = |why: &str| {
            let count = job.threads;
            let threads = if count == 1 { "thread" } else { "threads" };
            console.note(&format!("drawing on the CPU with {count} {threads}{why}"));
            film::CpuFilm::new(job).map(|film| Film::Cpu(Box::new(film)))
        };
        match self {
            Self::Cpu { why } => on_cpu(why),
            Self::Gpu { gpu, why, replaceable } => match gpu::film(gpu, job, why, console) {
                Err(error) if *replaceable => {
                    on_cpu(&format!(": the GPU does not draw this ({})", with_causes(&error)))
                }
                film => film.map(|film| Film::Gpu(Box::new(film))),
            },
        }
    }

    pub(crate) fn draw(&self, job: &DrawJob<'_>, console: &Console) -> Result<Drawn> {
        match self {
            Self::Cpu { why } => cpu::draw(job, why, console),
            Self::Gpu { gpu, why, replaceable } => match gpu::draw(gpu, job, why, console) {
                Err(error) if *replaceable => {
                    cpu::draw(job, &format!(": the GPU did not draw this ({})", with_causes(&error)), console)
                }
                outcome => outcome,
            },
        }
    }
}
