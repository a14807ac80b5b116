//! Textures of the renderer's own that pictures are drawn into.

use crate::device::wgpu_util::{texture_descriptor, whole_view};

/// Depth and multisampled colours, kept while pictures have the same size.
pub(crate) struct Attachments {
    depth: CachedView,
    multisampled: CachedView,
}

/// A texture's view, kept for the size that was drawn last.
struct CachedView {
    format: wgpu::TextureFormat,
    samples: u32,
    known: Option<([u32; 2], wgpu::TextureView)>,
}

impl Attachments {
    /// Attachments with as many samples per pixel as the hardware takes.
    pub(crate) fn new(depth: wgpu::TextureFormat, color: wgpu::TextureFormat, samples: u32) -> Self {
        let view = |format| CachedView { format, samples, known: None };
        Self { depth: view(depth), multisampled: view(color) }
    }

    /// Depth buffer of a picture of this size.
    pub(crate) fn depth(&mut self, device: &wgpu::Device, size: [u32; 2]) -> wgpu::TextureView {
        self.depth.get(device, size)
    }

    /// Depth buffer with a single sample per pixel.
    pub(crate) fn single_depth(&mut self, device: &wgpu::Device, size: [u32; 2]) -> wgpu::TextureView {
        match self.depth.samples {
            1 => self.depth.get(device, size),
            _ => attachment(device, size, self.depth.format, 1),
        }
    }

    /// Multisampled colours before they are resolved; `None` without multisampling.
    pub(crate) fn multisampled(&mut self, device: &wgpu::Device, size: [u32; 2]) -> Option<wgpu::TextureView> {
        (self.multisampled.samples > 1).then(|| self.multisampled.get(device, size))
    }
}

impl CachedView {
    fn get(&mut self, device: &wgpu::Device, size: [u32; 2]) -> wgpu::TextureView {
        match &self.known {
            Some((known, view)) if *known == size => view.clone(),
            _ => {
                let view = attachment(device, size, self.format, self.samples);
                self.known = Some((size, view.clone()));
                view
            }
        }
    }
}

fn attachment(
    device: &wgpu::Device,
    size: [u32; 2],
    format: wgpu::TextureFormat,
    sample_count: u32,
) -> wgpu::TextureView {
    let usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
    let descriptor = texture_descriptor("relievo attachment", size, format, usage);
    whole_view(&device.create_texture(&wgpu::TextureDescriptor { sample_count, ..descriptor }))
}
