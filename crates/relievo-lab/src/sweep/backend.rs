//! What marches rays and is timed at it.

use std::hint::black_box;
use std::time::Instant;

use relievo_map::Wrap;
use relievo_march::{HeightField, MarchOptions, Ray, Record, ReliefMap, march};

use super::fields::CellByCell;
#[cfg(feature = "gpu")]
use super::gpu::GpuMarchBackend;
use crate::{Candidate, LabError};

/// A backend that marches rays.
pub enum MarchBackend {
    /// One thread of the CPU.
    Cpu,
    /// The compute kernels of a GPU.
    #[cfg(feature = "gpu")]
    Gpu(Box<GpuMarchBackend>),
}

impl MarchBackend {
    /// The compute kernels on this GPU.
    ///
    /// # Errors
    /// If it cannot compute.
    #[cfg(feature = "gpu")]
    pub fn gpu(gpu: &relievo_gpu::Gpu) -> Result<Self, LabError> {
        Ok(Self::Gpu(Box::new(GpuMarchBackend::new(gpu)?)))
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
    pub(crate) fn load(&mut self, heights: &ReliefMap) -> Result<(), LabError> {
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
        heights: &ReliefMap,
        level: f32,
        candidate: &Candidate,
        rays: &[Ray],
    ) -> Result<Vec<Record>, LabError> {
        match self {
            Self::Cpu => Ok(on_cpu(heights, level, candidate, rays)),
            #[cfg(feature = "gpu")]
            Self::Gpu(bench) => bench.march(level, candidate, rays),
        }
    }

    /// Marches all rays once more, against the clock. On a GPU `many` rays are marched, to keep all of it busy.
    pub(crate) fn time(
        &mut self,
        heights: &ReliefMap,
        level: f32,
        candidate: &Candidate,
        rays: &[Ray],
        many: &[Ray],
        watch: &mut Stopwatch,
    ) -> Result<(), LabError> {
        match self {
            Self::Cpu => {
                let _ = many;
                for (part, rays) in rays.chunks(rays.len().div_ceil(PARTS).max(1)).enumerate() {
                    let start = Instant::now();
                    black_box(on_cpu(heights, level, candidate, rays));
                    watch.taken(part, rays.len(), start.elapsed().as_secs_f64());
                }
                Ok(())
            }
            #[cfg(feature = "gpu")]
            Self::Gpu(bench) => {
                watch.taken(0, many.len(), bench.time(level, candidate, many)?);
                Ok(())
            }
        }
    }
}

/// Rays are timed in so many parts, of each the best round: a thread that was interrupted spoils one part of one round.
const PARTS: usize = 16;

/// The best time of each part of some rays.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stopwatch {
    /// Rays and seconds.
    parts: Vec<(usize, f64)>,
}

impl Stopwatch {
    fn taken(&mut self, part: usize, rays: usize, seconds: f64) {
        match self.parts.get_mut(part) {
            Some(best) => best.1 = best.1.min(seconds),
            None => self.parts.push((rays, seconds)),
        }
    }

    pub(crate) fn ns_per_ray(&self) -> f64 {
        let (rays, seconds) = self.parts.iter().fold((0, 0.0), |sum, part| (sum.0 + part.0, sum.1 + part.1));
        seconds * 1e9 / rays.max(1) as f64
    }
}

/// On one thread.
fn on_cpu(heights: &ReliefMap, level: f32, candidate: &Candidate, rays: &[Ray]) -> Vec<Record> {
    let field = heights.field(level, Wrap::Repeat);
    let options = candidate.march();
    if candidate.is_cell_by_cell() {
        marched(&CellByCell(field), rays, &options)
    } else {
        marched(&field, rays, &options)
    }
}

fn marched(field: &impl HeightField, rays: &[Ray], options: &MarchOptions) -> Vec<Record> {
    rays.iter().map(|ray| march(field, ray, options)).collect()
}

/// The processor as the system names it.
fn cpu_name() -> String {
    let table = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = table.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    model.map_or_else(|| std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned())
}
