use relievo_gpu::{ComputeField, ComputeMarch, Gpu, HeightTexture, is_real};
use relievo_map::Wrap;
use relievo_march::{Ray, Record, ReliefMap};

use crate::error::LabError;
use crate::technique::ResolvedTechnique;

/// The compute kernels of a GPU, with and without the pyramid.
pub struct GpuMarchBackend {
    gpu: Gpu,
    name: String,
    march: ComputeMarch,
    cells: ComputeMarch,
    heights: Option<HeightTexture>,
}

impl GpuMarchBackend {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, LabError> {
        let march = ComputeMarch::new(&gpu.device, &gpu.queue)?;
        let cells = ComputeMarch::new(&gpu.device, &gpu.queue)?.without_pyramid();
        Ok(Self { gpu: gpu.clone(), name: gpu.name(), march, cells, heights: None })
    }

    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    pub(crate) fn load(&mut self, heights: &ReliefMap) -> Result<(), LabError> {
        self.heights = Some(HeightTexture::new(&self.gpu.device, &self.gpu.queue, heights)?);
        Ok(())
    }

    pub(crate) fn march(
        &mut self,
        level: f32,
        technique: &ResolvedTechnique,
        rays: &[Ray],
    ) -> Result<Vec<Record>, LabError> {
        let Some(heights) = &self.heights else { return Ok(Vec::new()) };
        let field = ComputeField { heights, lod: level, wrap: Wrap::Repeat };
        let kernels = if technique.is_cell_by_cell() { &mut self.cells } else { &mut self.march };
        Ok(kernels.march(field, rays, &technique.march_options())?)
    }

    /// The time of a dispatch over these rays, in seconds.
    pub(crate) fn time(&mut self, level: f32, technique: &ResolvedTechnique, rays: &[Ray]) -> Result<f64, LabError> {
        let Some(heights) = &self.heights else { return Ok(0.0) };
        let field = ComputeField { heights, lod: level, wrap: Wrap::Repeat };
        let kernels = if technique.is_cell_by_cell() { &mut self.cells } else { &mut self.march };
        let times = kernels.time(field, rays, &technique.march_options(), 1)?;
        // Timestamps of software adapters do not span the work of a compute pass.
        let real = is_real(&self.gpu.adapter.get_info());
        let taken = times.iter().map(|time| time.gpu.filter(|_| real).unwrap_or(time.wall).as_secs_f64());
        Ok(taken.fold(f64::INFINITY, f64::min))
    }
}
