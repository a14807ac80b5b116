//! The compute pipelines of [`crate::LiveHeights`], and lists of what they are to do.

use crate::layout::TaskLayout;
use crate::modules::module_source;
use crate::pyramid_plan::Part;

/// Texels along each side of a workgroup, as in the shaders.
const GROUP: u32 = 8;

/// The pipelines that build pyramids and mip levels, and what they bind.
#[derive(Debug)]
pub(crate) struct Kernels {
    pub(crate) build: wgpu::BindGroupLayout,
    pub(crate) halve: wgpu::BindGroupLayout,
    pub(crate) range: wgpu::ComputePipeline,
    pub(crate) base: wgpu::ComputePipeline,
    pub(crate) above: wgpu::ComputePipeline,
    pub(crate) header: wgpu::ComputePipeline,
    pub(crate) halving: wgpu::ComputePipeline,
}

/// What an update consists of.
#[derive(Default)]
pub(crate) struct Plan<'a> {
    /// Of all dispatches, each at a multiple of `stride` bytes.
    pub(crate) settings: Vec<u8>,
    pub(crate) stride: usize,
    pub(crate) dispatches: Vec<Dispatch<'a>>,
    /// Parts of the pyramids' levels, each with the row where its level begins.
    pub(crate) copies: Vec<(u32, Part)>,
}

pub(crate) struct Dispatch<'a> {
    pub(crate) pipeline: &'a wgpu::ComputePipeline,
    /// Whether it binds what halving binds.
    pub(crate) halves: bool,
    pub(crate) mip: usize,
    pub(crate) groups: [u32; 2],
}

impl<'a> Plan<'a> {
    pub(crate) fn dispatch(&mut self, pipeline: &'a wgpu::ComputePipeline, halves: bool, mip: usize, task: TaskLayout) {
        let start = self.settings.len();
        self.settings.extend_from_slice(bytemuck::bytes_of(&task));
        self.settings.resize(start + self.stride, 0);
        let groups = task.count.map(|n| n.div_ceil(GROUP));
        self.dispatches.push(Dispatch { pipeline, halves, mip, groups });
    }
}

impl Kernels {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let texture = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let task = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: true,
            min_binding_size: None,
        };
        let storage = |read_only| wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only },
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let target = wgpu::BindingType::StorageTexture {
            access: wgpu::StorageTextureAccess::WriteOnly,
            format: wgpu::TextureFormat::R32Float,
            view_dimension: wgpu::TextureViewDimension::D2,
        };
        let layout = |types: [wgpu::BindingType; 4]| {
            let entry = |(binding, ty)| wgpu::BindGroupLayoutEntry {
                binding: binding as u32,
                visibility: wgpu::ShaderStages::COMPUTE,
                ty,
                count: None,
            };
            let entries: Vec<_> = types.into_iter().enumerate().map(entry).collect();
            let label = Some("relievo pyramid");
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label, entries: &entries })
        };
        let build = layout([texture, task, storage(false), storage(false)]);
        let halve = layout([texture, task, storage(true), target]);
        let module = |name| {
            let source = wgpu::ShaderSource::Wgsl(module_source(name).unwrap_or_default().into());
            device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(name), source })
        };
        let pipeline = |module, entry_point, layout: &wgpu::BindGroupLayout| {
            let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(entry_point),
                bind_group_layouts: &[Some(layout)],
                immediate_size: 0,
            });
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry_point),
                layout: Some(&layout),
                module,
                entry_point: Some(entry_point),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            })
        };
        let (building, halving) = (module("pyramid_build"), module("halve"));
        Self {
            range: pipeline(&building, "pyramid_range", &build),
            base: pipeline(&building, "pyramid_base", &build),
            above: pipeline(&building, "pyramid_above", &build),
            header: pipeline(&building, "pyramid_header", &build),
            halving: pipeline(&halving, "halve", &halve),
            build,
            halve,
        }
    }
}
