use std::borrow::Cow;
use std::collections::HashMap;
use std::time::Instant;

use bytemuck::Pod;
use relievo_map::Wrap;
use relievo_march::{MarchOptions, Ray, Record, Shadow, ShadowRecord, Technique};
use relievo_shader::{Composer, MarchUniforms, Permutation};
use wgpu::util::DeviceExt;

use super::layout::{LightRayLayout, MarchJobLayout, RayLayout, RecordLayout, ShadowLayout};
use crate::device::wgpu_util::{
    bind_group, bind_group_layout, compute_pipeline, layout_entries, loaded_texture_type, storage_type, texture_type,
    uniform_type, view,
};
use crate::device::{Timer, guarded, read_buffer, wait};
use crate::{FrameTime, GpuError, HeightTexture, Tier};

/// The marches as compute kernels over buffers of rays: for measuring, and for machines whose fragment stage is slow.
///
/// Pipelines are made when they are first needed, and kept.
#[derive(Debug)]
pub struct ComputeMarch {
    pub(super) device: wgpu::Device,
    queue: wgpu::Queue,
    layout: wgpu::BindGroupLayout,
    modules: Vec<(String, Cow<'static, str>)>,
    without_pyramid: bool,
    pipelines: HashMap<(Permutation, MarchKernel), wgpu::ComputePipeline>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum MarchKernel {
    MarchRays,
    Shadow,
    Tile,
}

/// One dispatch with all it needs.
pub(super) struct DispatchJob {
    pipeline: wgpu::ComputePipeline,
    bindings: wgpu::BindGroup,
    /// Output.
    pub(super) records: wgpu::Buffer,
    workgroups: u32,
}

/// Input of a dispatch.
pub(super) struct DispatchInput<'a, I> {
    pub(super) options: &'a MarchOptions,
    pub(super) elements: &'a [I],
    /// Bytes of an element of the output.
    pub(super) output: usize,
    /// Rays that share an entry; 0: none do.
    pub(super) tile: u32,
    /// Entries of the tiles.
    pub(super) entries: Option<&'a wgpu::Buffer>,
}

/// Height map as rays see it.
#[derive(Clone, Copy, Debug)]
pub struct ComputeField<'a> {
    /// The map.
    pub heights: &'a HeightTexture,
    /// The mip level that is marched: 0 = full size, fractions mix two levels in filtered samples.
    pub lod: f32,
    /// Continuation of the map beyond its borders.
    pub wrap: Wrap,
}

impl ComputeMarch {
    /// Prepares kernels on this device.
    ///
    /// # Errors
    /// If the device has no compute shaders.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Self, GpuError> {
        if !Tier::of(device).computes() {
            return Err(GpuError::NoCompute);
        }
        let (device, queue) = (device.clone(), queue.clone());
        let unsigned = texture_type(wgpu::TextureSampleType::Uint, wgpu::TextureViewDimension::D2);
        let bindings = [
            (0, loaded_texture_type()),
            (1, uniform_type(false)),
            (2, storage_type(true)),
            (3, storage_type(false)),
            (4, unsigned),
            (5, storage_type(true)),
            (7, unsigned),
        ];
        let layout =
            bind_group_layout(&device, "relievo compute", &layout_entries(wgpu::ShaderStages::COMPUTE, &bindings));
        Ok(Self { device, queue, layout, modules: Vec::new(), without_pyramid: false, pipelines: HashMap::new() })
    }

    /// Makes `exact` cross every cell instead of asking the max pyramid, as [`relievo_march::WithoutPyramid`] does: the same
    /// hits, to measure what the pyramid saves.
    #[must_use]
    pub fn without_pyramid(self) -> Self {
        Self { without_pyramid: true, pipelines: HashMap::new(), ..self }
    }

    /// Adds a shader module, or replaces the one with this name: for marches of one's own. It is used from now
    /// on; whether it is right is found out when a march needs it.
    pub fn set_module(&mut self, name: impl Into<String>, source: impl Into<Cow<'static, str>>) {
        self.modules.push((name.into(), source.into()));
        self.pipelines.clear();
    }

    /// Gives what `relievo_march::march` gives for every ray, up to the rounding of the device. Blocks until it is done.
    ///
    /// # Errors
    /// If a module that was set is not valid, or the device fails.
    pub fn march(
        &mut self,
        field: ComputeField<'_>,
        rays: &[Ray],
        options: &MarchOptions,
    ) -> Result<Vec<Record>, GpuError> {
        let permutation = self.permutation(&field, options.technique, Shadow::None);
        let rays: Vec<RayLayout> = rays.iter().map(RayLayout::from).collect();
        let records: Vec<RecordLayout> = self.run(MarchKernel::MarchRays, &permutation, &field, options, &rays)?;
        Ok(records.iter().map(Record::from).collect())
    }

    /// Gives what `relievo_march::shadow` gives for every light ray and the depth it starts from, up to the rounding of the
    /// device. Blocks until it is done.
    ///
    /// # Errors
    /// As [`ComputeMarch::march`].
    pub fn shadow(
        &mut self,
        field: ComputeField<'_>,
        kind: Shadow,
        lights: &[(Ray, f32)],
        options: &MarchOptions,
    ) -> Result<Vec<ShadowRecord>, GpuError> {
        let permutation = self.permutation(&field, Technique::None, kind);
        let layout = |(light, depth): &(Ray, f32)| LightRayLayout { light: light.into(), depth: *depth, pad: 0 };
        let lights: Vec<LightRayLayout> = lights.iter().map(layout).collect();
        let factors: Vec<ShadowLayout> = self.run(MarchKernel::Shadow, &permutation, &field, options, &lights)?;
        Ok(factors.iter().map(ShadowRecord::from).collect())
    }

    /// Measures how long the rays of [`ComputeMarch::march`] take, `times` times after one that is not counted: the dispatch
    /// alone, without the way of rays and records to the device and back. Blocks.
    ///
    /// # Errors
    /// As [`ComputeMarch::march`], or if the rays are more than one dispatch can have.
    pub fn time(
        &mut self,
        field: ComputeField<'_>,
        rays: &[Ray],
        options: &MarchOptions,
        times: usize,
    ) -> Result<Vec<FrameTime>, GpuError> {
        self.check_one_dispatch(rays.len())?;
        let pipeline =
            self.pipeline(MarchKernel::MarchRays, &self.permutation(&field, options.technique, Shadow::None))?;
        let rays: Vec<RayLayout> = rays.iter().map(RayLayout::from).collect();
        self.timed(times, |this| {
            let output = size_of::<RecordLayout>();
            vec![this.job(
                (MarchKernel::MarchRays, pipeline),
                &field,
                &DispatchInput { options, elements: &rays, output, tile: 0, entries: None },
            )]
        })
    }

    pub(super) fn permutation(&self, field: &ComputeField<'_>, technique: Technique, shadow: Shadow) -> Permutation {
        Permutation {
            technique,
            shadow,
            wrap: field.wrap,
            eight_bit: field.heights.is_filtered_in_8_bits(),
            stretched: false,
            without_pyramid: self.without_pyramid,
            nearest: field.heights.is_sampled_nearest(),
            in_shells: false,
        }
    }

    pub(super) fn check_one_dispatch(&self, rays: usize) -> Result<(), GpuError> {
        let most = self.batch_size(size_of::<RayLayout>().max(size_of::<RecordLayout>()));
        if rays > most {
            return Err(GpuError::InvalidArgument(format!("{rays} rays are more than the {most} of one dispatch")));
        }
        Ok(())
    }

    /// Times jobs that follow each other, `times` times after one that is not counted.
    pub(super) fn timed(
        &self,
        times: usize,
        jobs: impl FnOnce(&Self) -> Vec<DispatchJob>,
    ) -> Result<Vec<FrameTime>, GpuError> {
        let device = self.device.clone();
        guarded(&device, || {
            let jobs = jobs(self);
            let timer = (Tier::of(&device) == Tier::Full).then(|| Timer::new(&device, &self.queue));
            let mut taken = Vec::with_capacity(times);
            for round in 0..=times {
                wait(&device)?;
                let start = Instant::now();
                let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
                record(&jobs, &mut encoder, timer.as_ref().map(Timer::compute_pass));
                self.queue.submit([encoder.finish()]);
                wait(&device)?;
                let wall = start.elapsed();
                let gpu = timer.as_ref().map(|timer| timer.elapsed(&device, &self.queue)).transpose()?;
                if round > 0 {
                    taken.push(FrameTime { gpu, wall });
                }
            }
            Ok(taken)
        })
    }

    /// Largest number of elements of one dispatch, if the larger of input and output has so many bytes.
    pub(super) fn batch_size(&self, element: usize) -> usize {
        let limits = self.device.limits();
        let groups = u64::from(limits.max_compute_workgroups_per_dimension) * u64::from(Tier::WORKGROUP);
        let batch = (limits.max_storage_buffer_binding_size.min(limits.max_buffer_size) / element as u64).min(groups);
        batch.max(1) as usize
    }

    pub(super) fn run<I: Pod, O: Pod>(
        &mut self,
        kernel: MarchKernel,
        permutation: &Permutation,
        field: &ComputeField<'_>,
        options: &MarchOptions,
        input: &[I],
    ) -> Result<Vec<O>, GpuError> {
        let pipeline = self.pipeline(kernel, permutation)?;
        let mut output = Vec::with_capacity(input.len());
        for input in input.chunks(self.batch_size(size_of::<I>().max(size_of::<O>()))) {
            let input = DispatchInput { options, elements: input, output: size_of::<O>(), tile: 0, entries: None };
            let [bytes] = guarded(&self.device, || self.batch(&[self.job((kernel, pipeline.clone()), field, &input)]))?;
            output.extend(bytes.chunks_exact(size_of::<O>()).map(bytemuck::pod_read_unaligned::<O>));
        }
        Ok(output)
    }

    /// Uploads the input of one dispatch.
    pub(super) fn job<I: Pod>(
        &self,
        (kernel, pipeline): (MarchKernel, wgpu::ComputePipeline),
        field: &ComputeField<'_>,
        &DispatchInput { options, elements, output, tile, entries }: &DispatchInput<'_, I>,
    ) -> DispatchJob {
        let device = &self.device;
        let heights = field.heights;
        let last = heights.last_level();
        let lod = field.lod.max(0.0).min(last as f32);
        let job = MarchJobLayout {
            options: MarchUniforms::from(options).to_bytes(),
            range: heights.ranges()[lod.round() as usize],
            lod,
            last_level: last as i32,
            count: elements.len() as u32,
            step: heights.quantization_step(),
            tile,
            pad: 0,
        };
        let init = |contents: &[u8], usage| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
        };
        let job = init(bytemuck::bytes_of(&job), wgpu::BufferUsages::UNIFORM);
        let rays = init(bytemuck::cast_slice(elements), wgpu::BufferUsages::STORAGE);
        let count = if kernel == MarchKernel::Tile { elements.len().div_ceil(tile as usize) } else { elements.len() };
        let no_entries = [0u8; 8];
        let entries = entries.cloned().unwrap_or_else(|| init(&no_entries, wgpu::BufferUsages::STORAGE));
        let records = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: (count * output) as u64,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let resources = vec![
            (0, view(heights.view())),
            (1, job.as_entire_binding()),
            (2, rays.as_entire_binding()),
            (3, records.as_entire_binding()),
            (4, view(heights.pyramid())),
            (5, entries.as_entire_binding()),
            (7, view(heights.cones(options.cones))),
        ];
        let bindings = bind_group(device, "relievo compute", &self.layout, resources);
        DispatchJob { pipeline, bindings, records, workgroups: (count as u32).div_ceil(Tier::WORKGROUP) }
    }

    /// Runs jobs that follow each other, and gives the bytes of their outputs.
    pub(super) fn batch<const N: usize>(&self, jobs: &[DispatchJob; N]) -> Result<[Vec<u8>; N], GpuError> {
        let device = &self.device;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        record(jobs, &mut encoder, None);
        let staging = jobs.each_ref().map(|job| {
            let staging = device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: job.records.size(),
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            encoder.copy_buffer_to_buffer(&job.records, 0, &staging, 0, None);
            staging
        });
        self.queue.submit([encoder.finish()]);
        let mut outputs = [const { Vec::new() }; N];
        for (output, staging) in outputs.iter_mut().zip(&staging) {
            *output = read_buffer(device, staging)?;
        }
        Ok(outputs)
    }

    pub(super) fn pipeline(
        &mut self,
        kernel: MarchKernel,
        permutation: &Permutation,
    ) -> Result<wgpu::ComputePipeline, GpuError> {
        if let Some(pipeline) = self.pipelines.get(&(*permutation, kernel)) {
            return Ok(pipeline.clone());
        }
        let mut composer = Composer::new(permutation);
        for (name, source) in &self.modules {
            composer.add(name.as_str(), source.clone());
        }
        let (module, entry) = match kernel {
            MarchKernel::MarchRays => ("compute_march", "relievo_march_rays"),
            MarchKernel::Shadow => ("compute_shadow", "relievo_shadow_rays"),
            MarchKernel::Tile => ("compute_tile", "relievo_tile_entries"),
        };
        let wgsl = composer.compose(module)?;
        let device = &self.device;
        let pipeline = guarded(device, || Ok(compute_pipeline(device, &self.layout, wgsl, entry)))?;
        self.pipelines.insert((*permutation, kernel), pipeline.clone());
        Ok(pipeline)
    }
}

/// Records dispatches that follow each other.
fn record(
    jobs: &[DispatchJob],
    encoder: &mut wgpu::CommandEncoder,
    timestamps: Option<wgpu::ComputePassTimestampWrites<'_>>,
) {
    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
        label: Some("relievo compute"),
        timestamp_writes: timestamps,
    });
    for job in jobs {
        pass.set_pipeline(&job.pipeline);
        pass.set_bind_group(0, &job.bindings, &[]);
        pass.dispatch_workgroups(job.workgroups, 1, 1);
    }
}
