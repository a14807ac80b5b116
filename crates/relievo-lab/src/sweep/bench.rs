//! What marches rays and is timed at it.

use std::time::Instant;

use relievo_map::Wrap;
use relievo_march::{HeightField, Heights, March, Ray, Record, march};

use super::fields::CellByCell;
#[cfg(feature = "gpu")]
use super::gpu::GpuBench;
use crate::{Candidate, LabError};

/// A backend that marches rays.
pub enum Bench {
    /// One thread of the CPU.
    Cpu,
    /// The compute kernels of a GPU.
    #[cfg(feature = "gpu")]
    Gpu(Box<GpuBench>),
}

impl Bench {
    /// The compute kernels on this GPU.
    ///
    /// # Errors
    /// If it cannot compute.
    #[cfg(feature = "gpu")]
    pub fn gpu(gpu: &relievo_gpu::Gpu) -> Result<Self, LabError> {
        Ok(Self::Gpu(Box::new(GpuBench::new(gpu)?)))
    }

    /// `cpu` or `gpu`.
    #[must_use]
    pub fn backend(&self) -> &'static str {
        match self {
            Self::Cpu => "cpu",
            #[cfg(feature = "gpu")]
            Self::Gpu(_) => "gpu",
        }
    }

    /// What it runs on, as reports say it.
    #[must_use]
    pub fn name(&self) -> String {
        match self {
            Self::Cpu => cpu_name(),
            #[cfg(feature = "gpu")]
            Self::Gpu(bench) => bench.name().to_owned(),
        }
    }

    /// Takes up a height map: what is marched from now on.
    pub(crate) fn load(&mut self, heights: &Heights) -> Result<(), LabError> {
        match self {
            Self::Cpu => {
                let _ = heights;
                Ok(())
            }
            #[cfg(feature = "gpu")]
            Self::Gpu(bench) => bench.load(heights),
        }
    }

    /// Marches all rays by a candidate, at a mip level of the map that was taken up.
    pub(crate) fn march(
        &mut self,
        heights: &Heights,
        level: f32,
        candidate: &Candidate,
        rays: &[Ray],
    ) -> Result<Vec<Record>, LabError> {
        match self {
            Self::Cpu => Ok(on_cpu(heights, level, candidate, rays).0),
            #[cfg(feature = "gpu")]
            Self::Gpu(bench) => bench.march(level, candidate, rays),
        }
    }

    /// Marches all rays once more; nanoseconds per ray. On a GPU `many` rays are marched, to keep all of it busy.
    pub(crate) fn time(
        &mut self,
        heights: &Heights,
        level: f32,
        candidate: &Candidate,
        rays: &[Ray],
        many: &[Ray],
    ) -> Result<f64, LabError> {
        match self {
            Self::Cpu => {
                let _ = many;
                Ok(on_cpu(heights, level, candidate, rays).1)
            }
            #[cfg(feature = "gpu")]
            Self::Gpu(bench) => bench.time(level, candidate, many),
        }
    }
}

/// One thread: the records, and nanoseconds per ray.
fn on_cpu(heights: &Heights, level: f32, candidate: &Candidate, rays: &[Ray]) -> (Vec<Record>, f64) {
    let field = heights.field(level, Wrap::Repeat);
    let how = candidate.march();
    if candidate.is_cell_by_cell() { marched(&CellByCell(field), rays, &how) } else { marched(&field, rays, &how) }
}

fn marched(field: &impl HeightField, rays: &[Ray], how: &March) -> (Vec<Record>, f64) {
    let mut records = Vec::with_capacity(rays.len());
    let start = Instant::now();
    records.extend(rays.iter().map(|ray| march(field, ray, how)));
    let seconds = start.elapsed().as_secs_f64();
    (records, seconds * 1e9 / rays.len().max(1) as f64)
}

/// The processor as the system names it.
fn cpu_name() -> String {
    let table = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = table.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    model.map_or_else(|| std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned())
}
