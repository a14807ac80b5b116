mod tiles;

use std::borrow::Cow;
use std::collections::HashMap;
use std::time::Instant;

use bytemuck::Pod;
use relievo_map::Wrap;
use relievo_march::{MarchOptions, Ray, Record, Shadow, ShadowRecord, Technique};
use wgpu::util::DeviceExt;

use crate::error::guarded;
use crate::layout::{JobLayout, LightRayLayout, RayLayout, RecordLayout, ShadowLayout};
use crate::offscreen::Clock;
use crate::readback::{read_buffer, wait};
use crate::{Composer, FrameTime, GpuError, HeightTexture, Permutation, Tier};

/// The marches as compute kernels over buffers of rays: for measuring, and for machines whose fragment stage is slow.
///
/// Pipelines are made when they are first needed, and kept.
#[derive(Debug)]
pub struct ComputeMarch {
    device: wgpu::Device,
    queue: wgpu::Queue,
    layout: wgpu::BindGroupLayout,
    modules: Vec<(String, Cow<'static, str>)>,
    pipelines: HashMap<(Permutation, Kernel), wgpu::ComputePipeline>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Kernel {
    MarchRays,
    Shadow,
    Tile,
}

/// One dispatch with all it needs.
struct Job {
    pipeline: wgpu::ComputePipeline,
    bindings: wgpu::BindGroup,
    /// What comes out.
    records: wgpu::Buffer,
    workgroups: u32,
}

/// What a dispatch works on.
struct Input<'a, I> {
    options: &'a MarchOptions,
    elements: &'a [I],
    /// Bytes of an element of the output.
    output: usize,
    /// Rays that share an entry; 0: none do.
    tile: u32,
    /// Of each tile.
    entries: Option<&'a wgpu::Buffer>,
}

/// The height map as rays see it.
#[derive(Clone, Copy, Debug)]
pub struct ComputeField<'a> {
    /// The map.
    pub heights: &'a HeightTexture,
    /// The mip level that is marched: 0 = full size, fractions mix two levels in filtered samples.
    pub lod: f32,
    /// What lies beyond the map's borders.
    pub wrap: Wrap,
}

impl ComputeMarch {
    /// Kernels on this device.
    ///
    /// # Errors
    /// If the device has no compute shaders.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Self, GpuError> {
        if !Tier::of(device).computes() {
            return Err(GpuError::NoCompute);
        }
        let (device, queue) = (device.clone(), queue.clone());
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("relievo compute"),
            entries: &[
                texture(0, wgpu::TextureSampleType::Float { filterable: false }),
                buffer(1, wgpu::BufferBindingType::Uniform),
                buffer(2, wgpu::BufferBindingType::Storage { read_only: true }),
                buffer(3, wgpu::BufferBindingType::Storage { read_only: false }),
                texture(4, wgpu::TextureSampleType::Uint),
                buffer(5, wgpu::BufferBindingType::Storage { read_only: true }),
                texture(7, wgpu::TextureSampleType::Uint),
            ],
        });
        Ok(Self { device, queue, layout, modules: Vec::new(), pipelines: HashMap::new() })
    }

    /// Adds a shader module, or takes the place of the one with this name: for marches of one's own. It is used from now
    /// on; whether it is right is found out when a march needs it.
    pub fn set_module(&mut self, name: impl Into<String>, source: impl Into<Cow<'static, str>>) {
        self.modules.push((name.into(), source.into()));
        self.pipelines.clear();
    }

    /// What `relievo_march::march` gives for every ray, up to the rounding of the device. Blocks until it is done.
    ///
    /// # Errors
    /// If a module that was set is not valid, or the device fails.
    pub fn march(
        &mut self,
        field: ComputeField<'_>,
        rays: &[Ray],
        options: &MarchOptions,
    ) -> Result<Vec<Record>, GpuError> {
        let permutation = permutation(&field, options.technique, Shadow::None);
        let rays: Vec<RayLayout> = rays.iter().map(RayLayout::from).collect();
        let records: Vec<RecordLayout> = self.run(Kernel::MarchRays, &permutation, &field, options, &rays)?;
        Ok(records.iter().map(Record::from).collect())
    }

    /// What `relievo_march::shadow` gives for every light ray and the depth it starts from, up to the rounding of the
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
        let permutation = permutation(&field, Technique::None, kind);
        let layout = |(light, depth): &(Ray, f32)| LightRayLayout { light: light.into(), depth: *depth, pad: 0 };
        let lights: Vec<LightRayLayout> = lights.iter().map(layout).collect();
        let factors: Vec<ShadowLayout> = self.run(Kernel::Shadow, &permutation, &field, options, &lights)?;
        Ok(factors.iter().map(ShadowRecord::from).collect())
    }

    /// How long the rays of [`ComputeMarch::march`] take, `times` times after one that is not counted: the dispatch alone,
    /// without the way of rays and records to the device and back. Blocks.
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
        let pipeline = self.pipeline(Kernel::MarchRays, &permutation(&field, options.technique, Shadow::None))?;
        let rays: Vec<RayLayout> = rays.iter().map(RayLayout::from).collect();
        self.timed(times, |this| {
            let output = size_of::<RecordLayout>();
            vec![this.job(
                (Kernel::MarchRays, pipeline),
                &field,
                &Input { options, elements: &rays, output, tile: 0, entries: None },
            )]
        })
    }

    fn check_one_dispatch(&self, rays: usize) -> Result<(), GpuError> {
        let most = self.batch_size(size_of::<RayLayout>().max(size_of::<RecordLayout>()));
        if rays > most {
            return Err(GpuError::Scene(format!("{rays} rays are more than the {most} of one dispatch")));
        }
        Ok(())
    }

    /// Times jobs that follow each other, `times` times after one that is not counted.
    fn timed(&self, times: usize, jobs: impl FnOnce(&Self) -> Vec<Job>) -> Result<Vec<FrameTime>, GpuError> {
        let device = self.device.clone();
        guarded(&device, || {
            let jobs = jobs(self);
            let clock = (Tier::of(&device) == Tier::Full).then(|| Clock::new(&device, &self.queue));
            let mut taken = Vec::with_capacity(times);
            for turn in 0..=times {
                wait(&device)?;
                let start = Instant::now();
                let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
                record(&jobs, &mut encoder, clock.as_ref().map(Clock::of_compute_pass));
                self.queue.submit([encoder.finish()]);
                wait(&device)?;
                let wall = start.elapsed();
                let gpu = clock.as_ref().map(|clock| clock.elapsed(&device, &self.queue)).transpose()?;
                if turn > 0 {
                    taken.push(FrameTime { gpu, wall });
                }
            }
            Ok(taken)
        })
    }

    /// The most elements of one dispatch, if the larger of input and output has so many bytes.
    fn batch_size(&self, element: usize) -> usize {
        let limits = self.device.limits();
        let groups = u64::from(limits.max_compute_workgroups_per_dimension) * u64::from(Tier::WORKGROUP);
        let batch = (limits.max_storage_buffer_binding_size.min(limits.max_buffer_size) / element as u64).min(groups);
        batch.max(1) as usize
    }

    fn run<I: Pod, O: Pod>(
        &mut self,
        kernel: Kernel,
        permutation: &Permutation,
        field: &ComputeField<'_>,
        options: &MarchOptions,
        input: &[I],
    ) -> Result<Vec<O>, GpuError> {
        let pipeline = self.pipeline(kernel, permutation)?;
        let mut output = Vec::with_capacity(input.len());
        for input in input.chunks(self.batch_size(size_of::<I>().max(size_of::<O>()))) {
            let input = Input { options, elements: input, output: size_of::<O>(), tile: 0, entries: None };
            let [bytes] = guarded(&self.device, || self.batch(&[self.job((kernel, pipeline.clone()), field, &input)]))?;
            output.extend(bytes.chunks_exact(size_of::<O>()).map(bytemuck::pod_read_unaligned::<O>));
        }
        Ok(output)
    }

    /// Puts the input of one dispatch on the device.
    fn job<I: Pod>(
        &self,
        (kernel, pipeline): (Kernel, wgpu::ComputePipeline),
        field: &ComputeField<'_>,
        &Input { options, elements, output, tile, entries }: &Input<'_, I>,
    ) -> Job {
        let device = &self.device;
        let heights = field.heights;
        let last = heights.last_level();
        let lod = field.lod.max(0.0).min(last as f32);
        let job = JobLayout {
            options: options.into(),
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
        let count = if kernel == Kernel::Tile { elements.len().div_ceil(tile as usize) } else { elements.len() };
        let no_entries = [0u8; 8];
        let entries = entries.cloned().unwrap_or_else(|| init(&no_entries, wgpu::BufferUsages::STORAGE));
        let records = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: (count * output) as u64,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("relievo compute"),
            layout: &self.layout,
            entries: &[
                entry(0, wgpu::BindingResource::TextureView(heights.view())),
                entry(1, job.as_entire_binding()),
                entry(2, rays.as_entire_binding()),
                entry(3, records.as_entire_binding()),
                entry(4, wgpu::BindingResource::TextureView(heights.pyramid())),
                entry(5, entries.as_entire_binding()),
                entry(7, wgpu::BindingResource::TextureView(heights.cones(options.cones))),
            ],
        });
        Job { pipeline, bindings, records, workgroups: (count as u32).div_ceil(Tier::WORKGROUP) }
    }

    /// Runs jobs that follow each other; the bytes of their outputs.
    fn batch<const N: usize>(&self, jobs: &[Job; N]) -> Result<[Vec<u8>; N], GpuError> {
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

    fn pipeline(&mut self, kernel: Kernel, permutation: &Permutation) -> Result<wgpu::ComputePipeline, GpuError> {
        if let Some(pipeline) = self.pipelines.get(&(*permutation, kernel)) {
            return Ok(pipeline.clone());
        }
        let mut composer = Composer::new(permutation);
        for (name, source) in &self.modules {
            composer.add(name.as_str(), source.clone());
        }
        let (module, entry) = match kernel {
            Kernel::MarchRays => ("compute_march", "march_rays"),
            Kernel::Shadow => ("compute_shadow", "shadow_rays"),
            Kernel::Tile => ("compute_tile", "tile_entries"),
        };
        let wgsl = composer.compose(module)?;
        let device = &self.device;
        let pipeline = guarded(device, || {
            let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(module),
                source: wgpu::ShaderSource::Wgsl(wgsl.into()),
            });
            let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(module),
                bind_group_layouts: &[Some(&self.layout)],
                immediate_size: 0,
            });
            Ok(device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(module),
                layout: Some(&layout),
                module: &shader,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            }))
        })?;
        self.pipelines.insert((*permutation, kernel), pipeline.clone());
        Ok(pipeline)
    }
}

/// Records dispatches that follow each other.
fn record(jobs: &[Job], encoder: &mut wgpu::CommandEncoder, timestamps: Option<wgpu::ComputePassTimestampWrites<'_>>) {
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

fn permutation(field: &ComputeField<'_>, technique: Technique, shadow: Shadow) -> Permutation {
    Permutation {
        technique,
        shadow,
        wrap: field.wrap,
        eight_bit: field.heights.is_filtered_in_8_bits(),
        stretched: false,
    }
}

fn texture(binding: u32, sample_type: wgpu::TextureSampleType) -> wgpu::BindGroupLayoutEntry {
    let ty =
        wgpu::BindingType::Texture { sample_type, view_dimension: wgpu::TextureViewDimension::D2, multisampled: false };
    wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::COMPUTE, ty, count: None }
}

fn buffer(binding: u32, ty: wgpu::BufferBindingType) -> wgpu::BindGroupLayoutEntry {
    let ty = wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::COMPUTE, ty, count: None }
}
