//! The environment map on the device.

use half::f16;
use relievo_map::Grid;
use relievo_scene::EnvironmentMap;
use wgpu::util::DeviceExt;

use crate::GpuError;
use crate::device::wgpu_util::{check_size, extent, texture_descriptor};

/// Textures and buffers of the environment; where there is none, something to bind.
pub(crate) struct EnvironmentTextures {
    pub(crate) picture: wgpu::TextureView,
    pub(crate) blurred: wgpu::TextureView,
    pub(crate) sampler: wgpu::Sampler,
    pub(crate) harmonics: wgpu::Buffer,
}

impl EnvironmentTextures {
    pub(crate) fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        environment: Option<&EnvironmentMap>,
    ) -> Result<Self, GpuError> {
        let black = Grid::filled(1, 1, [0.0; 3]);
        let (picture, blurred) = match environment.and_then(|known| known.levels().split_first()) {
            Some((picture, blurred)) => (picture, blurred),
            None => (&black, std::slice::from_ref(&black)),
        };
        check_size(device, "the environment", picture.width(), picture.height())?;
        let weights: Vec<[f32; 4]> = match environment {
            Some(known) => known.harmonics().iter().map(|weight| weight.extend(0.0).to_array()).collect(),
            None => vec![[0.0; 4]; 9],
        };
        let harmonics = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("relievo harmonics"),
            contents: bytemuck::cast_slice(&weights),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("relievo environment"),
            address_mode_u: wgpu::AddressMode::Repeat,
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..wgpu::SamplerDescriptor::default()
        });
        let picture = upload(device, queue, std::slice::from_ref(picture), wgpu::TextureViewDimension::D2);
        let blurred = upload(device, queue, blurred, wgpu::TextureViewDimension::D2Array);
        Ok(Self { picture, blurred, sampler, harmonics })
    }
}

/// Pictures of one size as the layers of a texture of half floats: the brightest sun they can hold is 65504.
fn upload(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    layers: &[Grid<[f32; 3]>],
    dimension: wgpu::TextureViewDimension,
) -> wgpu::TextureView {
    let (width, height) = layers.first().map_or((1, 1), |layer| (layer.width(), layer.height()));
    let texels: Vec<[u16; 4]> = layers
        .iter()
        .flat_map(Grid::texels)
        .map(|&[r, g, b]| [r, g, b, 1.0].map(|x| f16::from_f32(x.min(f16::MAX.to_f32())).to_bits()))
        .collect();
    let usage = wgpu::TextureUsages::TEXTURE_BINDING;
    let one = texture_descriptor("relievo environment", [width, height], wgpu::TextureFormat::Rgba16Float, usage);
    let depth_or_array_layers = layers.len().max(1) as u32;
    let descriptor =
        wgpu::TextureDescriptor { size: wgpu::Extent3d { depth_or_array_layers, ..extent([width, height]) }, ..one };
    let order = wgpu::util::TextureDataOrder::LayerMajor;
    let texture = device.create_texture_with_data(queue, &descriptor, order, bytemuck::cast_slice(&texels));
    texture.create_view(&wgpu::TextureViewDescriptor { dimension: Some(dimension), ..Default::default() })
}
