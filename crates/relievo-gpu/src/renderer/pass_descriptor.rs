//! Description of a pass over all objects.

use super::permutation::Pass;

/// A pass to be recorded.
pub(crate) struct PassDescriptor<'a> {
    pub(crate) kind: Pass,
    pub(crate) colors: &'a [Option<wgpu::RenderPassColorAttachment<'a>>],
    pub(crate) depth: &'a wgpu::TextureView,
    /// True if depth stays as it was drawn before.
    pub(crate) keeps_depth: bool,
    pub(crate) bindings: &'a wgpu::BindGroup,
    /// Index of the view in its buffer.
    pub(crate) view: u32,
    pub(crate) timestamps: Option<wgpu::RenderPassTimestampWrites<'a>>,
}

/// A colour attachment that is cleared and stored.
pub(crate) fn cleared(view: &wgpu::TextureView, color: wgpu::Color) -> wgpu::RenderPassColorAttachment<'_> {
    let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(color), store: wgpu::StoreOp::Store };
    wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops }
}
