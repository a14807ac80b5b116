//! The compute pipelines of [`crate::LiveHeights`], and lists of what they are to do.

use crate::layout::TaskLayout;
use crate::pyramid_plan::Part;
use relievo_shader::module_source;

/// Texels along each side of a workgroup, as in the shaders.
const GROUP: u32 = 8;

/// The pipelines that build pyramids, and what they bind.
#[derive(Debug)]
pub(crate) struct Kernels {
    pub(crate) layout: wgpu::BindGroupLayout,
    pub(crate) range: wgpu::ComputePipeline,
    pub(crate) base: wgpu::ComputePipeline,
    pub(crate) above: wgpu::ComputePipeline,
    pub(crate) header: wgpu::ComputePipeline,
}

/// What an update of pyramids consists of.
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
    pub(crate) mip: usize,
    pub(crate) groups: [u32; 2],
}

impl<'a> Plan<'a> {
    pub(crate) fn dispatch(&mut self, pipeline: &'a wgpu::ComputePipeline, mip: usize, task: TaskLayout) {
        let start = self.settings.len();
        self.settings.extend_from_slice(bytemuck::bytes_of(&task));
        self.settings.resize(start + self.stride, 0);
        self.dispatches.push(Dispatch { pipeline, mip, groups: groups(task.count) });
    }
}

impl Kernels {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let layout = bind_group_layout(device, [texture(), task(), storage(false), storage(false)]);
        let kernel = |entry_point| pipeline(device, &layout, "pyramid_build", entry_point);
        Self {
            range: kernel("pyramid_range"),
            base: kernel("pyramid_base"),
            above: kernel("pyramid_above"),
            header: kernel("pyramid_header"),
            layout,
        }
    }
}

/// Workgroups for so many invocations along u and v.
pub(crate) fn groups(count: [u32; 2]) -> [u32; 2] {
    count.map(|n| n.div_ceil(GROUP))
}

/// A height map at one level.
pub(crate) fn texture() -> wgpu::BindingType {
    wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: false },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    }
}

/// The settings of a dispatch among those of others.
pub(crate) fn task() -> wgpu::BindingType {
    wgpu::BindingType::Buffer { ty: wgpu::BufferBindingType::Uniform, has_dynamic_offset: true, min_binding_size: None }
}

pub(crate) fn storage(read_only: bool) -> wgpu::BindingType {
    wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only },
        has_dynamic_offset: false,
        min_binding_size: None,
    }
}

/// A layout of bindings from 0 on.
pub(crate) fn bind_group_layout(device: &wgpu::Device, types: [wgpu::BindingType; 4]) -> wgpu::BindGroupLayout {
    let mut binding = 0..;
    let entries = types.map(|ty| wgpu::BindGroupLayoutEntry {
        binding: binding.next().unwrap_or_default(),
        visibility: wgpu::ShaderStages::COMPUTE,
        ty,
        count: None,
    });
    let label = Some("relievo pyramid");
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label, entries: &entries })
}

/// An entry point of a module that imports nothing.
pub(crate) fn pipeline(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    module: &str,
    entry_point: &str,
) -> wgpu::ComputePipeline {
    let source = wgpu::ShaderSource::Wgsl(module_source(module).unwrap_or_default().into());
    let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(module), source });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(entry_point),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(entry_point),
        layout: Some(&layout),
        module: &shader,
        entry_point: Some(entry_point),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    })
}
