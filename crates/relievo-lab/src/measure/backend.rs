use std::hint::black_box;
use std::time::Instant;

use relievo_map::Wrap;
use relievo_march::{HeightField, MarchOptions, Ray, Record, ReliefMap, Technique, WithoutPyramid, march};

#[cfg(feature = "gpu")]
use super::gpu::GpuMarchBackend;
use super::stopwatch::Stopwatch;
use crate::error::LabError;
use crate::technique::ResolvedTechnique;

/// A backend that marches rays.
#[non_exhaustive]
pub enum MarchBackend {
    /// One thread of the CPU.
    Cpu,
    /// The compute kernels of a GPU.
    #[cfg(feature = "gpu")]
    Gpu(Box<GpuMarchBackend>),
}

impl MarchBackend {
    /// Creates the backend of this GPU's compute kernels.
    ///
    /// # Errors
    /// If it cannot compute.
    #[cfg(feature = "gpu")]
    pub fn gpu(gpu: &relievo_gpu::Gpu) -> Result<Self, LabError> {
        Ok(Self::Gpu(Box::new(GpuMarchBackend::new(gpu)?)))
    }

    /// Returns `cpu` or `gpu`.
    #[must_use]
    pub fn backend(&self) -> &'static str {
        match self {
            Self::Cpu => "cpu",
            #[cfg(feature = "gpu")]
            Self::Gpu(_) => "gpu",
        }
    }

    /// The name of the processor or adapter, for reports.
    #[must_use]
    pub fn name(&self) -> String {
        match self {
            Self::Cpu => cpu_name(),
            #[cfg(feature = "gpu")]
            Self::Gpu(gpu) => gpu.name().to_owned(),
        }
    }

    /// Loads the height map that is marched next.
    pub(crate) fn load(&mut self, heights: &ReliefMap) -> Result<(), LabError> {
        match self {
            Self::Cpu => {
                let _ = heights;
                Ok(())
            }
            #[cfg(feature = "gpu")]
            Self::Gpu(gpu) => gpu.load(heights),
        }
    }

    /// Marches all rays at a mip level of the loaded map.
    pub(crate) fn march(
        &mut self,
        heights: &ReliefMap,
        level: f32,
        technique: &ResolvedTechnique,
        rays: &[Ray],
    ) -> Result<Vec<Record>, LabError> {
        match self {
            Self::Cpu => Ok(march_on_cpu(heights, level, technique, rays)),
            #[cfg(feature = "gpu")]
            Self::Gpu(gpu) => gpu.march(level, technique, rays),
        }
    }

    /// Marches all rays once and adds the time to `watch`. A GPU marches `many` instead, to be fully occupied.
    pub(crate) fn time(
        &mut self,
        heights: &ReliefMap,
        level: f32,
        technique: &ResolvedTechnique,
        rays: &[Ray],
        many: &[Ray],
        watch: &mut Stopwatch,
    ) -> Result<(), LabError> {
        match self {
            Self::Cpu => {
                let _ = many;
                for (part, rays) in rays.chunks(rays.len().div_ceil(PARTS).max(1)).enumerate() {
                    let start = Instant::now();
                    black_box(march_on_cpu(heights, level, technique, rays));
                    watch.add(part, rays.len(), start.elapsed().as_secs_f64());
                }
                Ok(())
            }
            #[cfg(feature = "gpu")]
            Self::Gpu(gpu) => {
                watch.add(0, many.len(), gpu.time(level, technique, many)?);
                Ok(())
            }
        }
    }
}

/// Parts in which the rays of a round are timed on the CPU.
const PARTS: usize = 16;

/// Marches rays on one thread.
fn march_on_cpu(heights: &ReliefMap, level: f32, technique: &ResolvedTechnique, rays: &[Ray]) -> Vec<Record> {
    let field = heights.field(level, Wrap::Repeat);
    let options = technique.march_options();
    if technique.is_cell_by_cell() {
        march_rays(&WithoutPyramid(field), rays, &options)
    } else {
        march_rays(&field, rays, &options)
    }
}

fn march_rays(field: &impl HeightField, rays: &[Ray], options: &MarchOptions) -> Vec<Record> {
    rays.iter().map(|ray| march(field, ray, options)).collect()
}

/// The processor's name, from the operating system.
fn cpu_name() -> String {
    let table = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = table.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    model.map_or_else(|| std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned())
}

/// Adds the cone maps that these techniques march.
pub(crate) fn with_cones(heights: ReliefMap, techniques: &[ResolvedTechnique]) -> ReliefMap {
    let needed = techniques.iter().filter(|technique| technique.technique() == Technique::Cone);
    needed.fold(heights, |heights, technique| heights.with_cones(technique.march_options().cones))
}
