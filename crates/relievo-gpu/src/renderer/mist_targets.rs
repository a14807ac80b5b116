//! What mist is drawn from and into, for the size that was drawn last.

use super::formats::{DEPTH_FORMAT, SHARE_FORMAT};
use super::mist_layout::MistLayout;
use super::shadow_maps::array_layers;
use crate::device::wgpu_util::{bind_group, one_of, texture_descriptor, view, whole_view};

#[derive(Clone)]
pub(crate) struct MistTargets {
    pub(super) size: [u32; 2],
    lights: usize,
    /// Depth of the surfaces behind the mist.
    pub(super) depth: wgpu::TextureView,
    /// Shares of the lights that pass the mist to those surfaces, a layer for each light.
    pub(super) layers: Vec<wgpu::TextureView>,
    /// Bindings of group 3: of the passes over mist, and of surfaces.
    pub(super) over_surfaces: wgpu::BindGroup,
    pub(super) past_mist: wgpu::BindGroup,
}

impl MistTargets {
    /// Makes targets for pictures of this size and this number of lights; `dims`: some surface is dimmed. The layouts are those of
    /// group 3, of the passes over mist and of surfaces.
    pub(super) fn new(
        device: &wgpu::Device,
        [over_layout, past_layout]: [&wgpu::BindGroupLayout; 2],
        settings: &wgpu::Buffer,
        (size, lights): ([u32; 2], usize),
        dims: bool,
    ) -> Self {
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let depth = device.create_texture(&texture_descriptor("relievo depth behind mist", size, DEPTH_FORMAT, usage));
        let depth = whole_view(&depth);
        // Where no surface is dimmed, something to bind.
        let (extent, count) = if dims { (size, lights) } else { ([1; 2], 0) };
        let descriptor = texture_descriptor("relievo lights past mist", extent, SHARE_FORMAT, usage);
        let shares = device.create_texture(&wgpu::TextureDescriptor {
            size: wgpu::Extent3d { depth_or_array_layers: array_layers(count), ..descriptor.size },
            ..descriptor
        });
        let layer = |first: usize| {
            shares.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_array_layer: first as u32,
                array_layer_count: Some(1),
                ..Default::default()
            })
        };
        let all = shares.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let settings = one_of(settings, size_of::<MistLayout>());
        let over_surfaces = bind_group(device, "relievo mist", over_layout, vec![(0, settings), (1, view(&depth))]);
        let past_mist = bind_group(device, "relievo lights past mist", past_layout, vec![(0, view(&all))]);
        Self { size, lights, depth, layers: (0..count).map(layer).collect(), over_surfaces, past_mist }
    }

    /// Returns true if they are for pictures of this size with this many lights.
    pub(super) fn fit(&self, size: [u32; 2], lights: usize) -> bool {
        (self.size, self.lights) == (size, lights)
    }
}
