//! The compute pipelines of [`crate::LiveHeights`], and lists of their dispatches.

use relievo_shader::module_source;

use super::layout::PyramidTaskLayout;
use super::pyramid_layout::TexelSpan;
use crate::device::wgpu_util::{
    bind_group_layout, compute_pipeline, layout_entries, loaded_texture_type, storage_type, uniform_type,
};

/// Texels along each side of a workgroup, as in the shaders.
const GROUP: u32 = 8;

/// The pipelines that build pyramids, and the layout of their bindings.
#[derive(Debug)]
pub(crate) struct PyramidKernels {
    pub(crate) layout: wgpu::BindGroupLayout,
    pub(crate) range: wgpu::ComputePipeline,
    pub(crate) base: wgpu::ComputePipeline,
    pub(crate) above: wgpu::ComputePipeline,
    pub(crate) header: wgpu::ComputePipeline,
}

/// Dispatches and copies of an update of pyramids.
#[derive(Default)]
pub(crate) struct PyramidUpdate<'a> {
    /// Settings of all dispatches, each at a multiple of `stride` bytes.
    pub(crate) settings: Vec<u8>,
    pub(crate) stride: usize,
    pub(crate) dispatches: Vec<PyramidDispatch<'a>>,
    /// Parts of the pyramids' levels, each with the row where its level begins.
    pub(crate) copies: Vec<(u32, TexelSpan)>,
}

pub(crate) struct PyramidDispatch<'a> {
    pub(crate) pipeline: &'a wgpu::ComputePipeline,
    pub(crate) mip: usize,
    pub(crate) groups: [u32; 2],
}

impl<'a> PyramidUpdate<'a> {
    pub(crate) fn dispatch(&mut self, pipeline: &'a wgpu::ComputePipeline, mip: usize, task: PyramidTaskLayout) {
        let start = self.settings.len();
        self.settings.extend_from_slice(bytemuck::bytes_of(&task));
        self.settings.resize(start + self.stride, 0);
        self.dispatches.push(PyramidDispatch { pipeline, mip, groups: groups(task.count) });
    }
}

impl PyramidKernels {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let layout = kernel_layout(device, storage_type(false));
        let kernel = |entry_point| module_pipeline(device, &layout, "pyramid_build", entry_point);
        Self {
            range: kernel("relievo_pyramid_range"),
            base: kernel("relievo_pyramid_base"),
            above: kernel("relievo_pyramid_above"),
            header: kernel("relievo_pyramid_header"),
            layout,
        }
    }
}

/// Workgroups for so many invocations along u and v.
pub(crate) fn groups(count: [u32; 2]) -> [u32; 2] {
    count.map(|n| n.div_ceil(GROUP))
}

/// Layout of a kernel's bindings: a height map at one level, settings of a dispatch among those of others, and two storage
/// buffers, of which `second` is the type of the first.
pub(crate) fn kernel_layout(device: &wgpu::Device, second: wgpu::BindingType) -> wgpu::BindGroupLayout {
    let bindings = [(0, loaded_texture_type()), (1, uniform_type(true)), (2, second), (3, storage_type(false))];
    bind_group_layout(device, "relievo pyramid", &layout_entries(wgpu::ShaderStages::COMPUTE, &bindings))
}

/// Pipeline of an entry point of a module that imports nothing.
pub(crate) fn module_pipeline(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    module: &str,
    entry_point: &str,
) -> wgpu::ComputePipeline {
    compute_pipeline(device, layout, module_source(module).unwrap_or_default().to_owned(), entry_point)
}
