//! Marches that begin where one look ahead for a whole tile of rays says.

use relievo_march::{MarchOptions, Ray, Record, Shadow, TileEntry};

use super::layout::{RayLayout, RecordLayout, TileEntryLayout};
use super::march::{ComputeField, ComputeMarch, DispatchInput, DispatchJob, MarchKernel};
use crate::device::guarded;
use crate::{FrameTime, GpuError};

impl ComputeMarch {
    /// Rays of a tile: 8 × 4 neighbours.
    pub const TILE: usize = 32;

    /// Marches as [`ComputeMarch::march`] with a coarse pass before it: every [`ComputeMarch::TILE`] rays that follow each
    /// other are a tile, are looked at by `relievo_march::tile_entry`, and march from there as `relievo_march::march_from`
    /// does. Gives the entries too, with what they cost. Blocks until it is done.
    ///
    /// # Errors
    /// As [`ComputeMarch::march`].
    pub fn march_tiles(
        &mut self,
        field: ComputeField<'_>,
        rays: &[Ray],
        options: &MarchOptions,
    ) -> Result<(Vec<Record>, Vec<TileEntry>), GpuError> {
        let pipelines = self.tile_pipelines(&field, options)?;
        let rays: Vec<RayLayout> = rays.iter().map(RayLayout::from).collect();
        let (mut records, mut entries) = (Vec::new(), Vec::new());
        let most = self.batch_size(size_of::<RayLayout>().max(size_of::<RecordLayout>()));
        for rays in rays.chunks((most / Self::TILE).max(1) * Self::TILE) {
            let [before, after] =
                guarded(&self.device, || self.batch(&self.tile_jobs(pipelines.clone(), &field, options, rays)))?;
            let stored = before.chunks_exact(size_of::<TileEntryLayout>()).map(bytemuck::pod_read_unaligned);
            entries.extend(stored.map(|stored: TileEntryLayout| TileEntry::from(&stored)));
            let stored = after.chunks_exact(size_of::<RecordLayout>()).map(bytemuck::pod_read_unaligned);
            records.extend(stored.map(|stored: RecordLayout| Record::from(&stored)));
        }
        Ok((records, entries))
    }

    /// Measures as [`ComputeMarch::time`], for [`ComputeMarch::march_tiles`]: both dispatches together.
    ///
    /// # Errors
    /// As [`ComputeMarch::time`].
    pub fn time_tiles(
        &mut self,
        field: ComputeField<'_>,
        rays: &[Ray],
        options: &MarchOptions,
        times: usize,
    ) -> Result<Vec<FrameTime>, GpuError> {
        self.check_one_dispatch(rays.len())?;
        let pipelines = self.tile_pipelines(&field, options)?;
        let rays: Vec<RayLayout> = rays.iter().map(RayLayout::from).collect();
        self.timed(times, |this| this.tile_jobs(pipelines, &field, options, &rays).into())
    }

    fn tile_pipelines(
        &mut self,
        field: &ComputeField<'_>,
        options: &MarchOptions,
    ) -> Result<[wgpu::ComputePipeline; 2], GpuError> {
        let permutation = self.permutation(field, options.technique, Shadow::None);
        Ok([self.pipeline(MarchKernel::Tile, &permutation)?, self.pipeline(MarchKernel::MarchRays, &permutation)?])
    }

    /// The coarse pass, and the march that begins where it says.
    fn tile_jobs(
        &self,
        [before, after]: [wgpu::ComputePipeline; 2],
        field: &ComputeField<'_>,
        options: &MarchOptions,
        rays: &[RayLayout],
    ) -> [DispatchJob; 2] {
        let tile = Self::TILE as u32;
        let output = size_of::<TileEntryLayout>();
        let input = DispatchInput { options, elements: rays, output, tile, entries: None };
        let before = self.job((MarchKernel::Tile, before), field, &input);
        let input = DispatchInput { output: size_of::<RecordLayout>(), entries: Some(&before.records), ..input };
        let after = self.job((MarchKernel::MarchRays, after), field, &input);
        [before, after]
    }
}
