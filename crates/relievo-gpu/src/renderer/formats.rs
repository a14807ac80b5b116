//! Texture formats that passes and pipelines agree on.

/// Depth runs from 1 at the near plane to 0 at infinity: with floats, precise everywhere.
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Format of measured numbers.
pub(crate) const MEASURE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// Format of the numbers of objects in shadow maps.
pub(crate) const OBJECT_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R16Uint;

/// Format of the shares of lights that mist lets through.
pub(crate) const SHARE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;

/// Format that samples are drawn and summed in: floats, for colours are clamped only after averaging.
pub(crate) const SAMPLE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
