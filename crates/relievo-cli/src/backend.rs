//! Drawing a scene on the CPU or on a GPU, with the same result.

use anyhow::{Result, bail};
use clap::ValueEnum;
use relievo_map::Grid;
use relievo_scene::{Aovs, Scene};

use crate::console::{Console, WrongUsage, with_causes};

mod cpu;
#[cfg(feature = "gpu")]
pub(crate) mod gpu;
#[cfg(not(feature = "gpu"))]
#[path = "backend/no_gpu.rs"]
pub(crate) mod gpu;

/// The backend that draws.
#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum Backend {
    Auto,
    Cpu,
    Gpu,
}

/// A scene to draw, and the results that are wanted.
// Only GPUs have to be told what is wanted: the CPU measures and times all that it draws.
#[cfg_attr(not(feature = "gpu"), allow(dead_code))]
pub(crate) struct DrawJob<'a> {
    pub(crate) scene: &'a Scene,
    /// Name of the scene in errors.
    pub(crate) name: String,
    /// Threads of the CPU: those asked for, and those there will be.
    pub(crate) threads: (Option<usize>, usize),
    pub(crate) frames: u32,
    /// True if times are wanted.
    pub(crate) timed: bool,
    /// True if AOVs are wanted.
    pub(crate) measured: bool,
}

/// The drawn picture, with figures.
pub(crate) struct Drawn {
    pub(crate) backend: &'static str,
    pub(crate) adapter: String,
    pub(crate) pixels: Grid<[u8; 3]>,
    /// `None` where a backend does not have them without being asked, and was not asked.
    pub(crate) aovs: Option<Aovs>,
    pub(crate) triangles: usize,
    pub(crate) build_ms: f64,
    pub(crate) times: Times,
}

/// Times of the frames, milliseconds.
pub(crate) struct Times {
    /// By the device's own clock, where it has one.
    pub(crate) gpu: Option<Vec<f64>>,
    /// By the program's clock.
    pub(crate) wall: Vec<f64>,
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
