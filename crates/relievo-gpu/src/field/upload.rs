//! Textures from the bytes that relievo-shader lays out.

use relievo_shader::TextureBytes;

use crate::GpuError;
use crate::device::wgpu_util::{texture_descriptor, texture_format, whole_view, write_level};

/// Uploads a texture that shaders may bind, with further usages.
pub(crate) fn upload(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    label: &str,
    texture: &TextureBytes,
    usage: wgpu::TextureUsages,
) -> Result<wgpu::TextureView, GpuError> {
    let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST | usage;
    let descriptor = texture_descriptor(label, texture.size(), texture_format(texture.format)?, usage);
    let mip_level_count = texture.mips.len() as u32;
    let made = device.create_texture(&wgpu::TextureDescriptor { mip_level_count, ..descriptor });
    for (level, mip) in texture.mips.iter().enumerate() {
        write_level(queue, &made, level as u32, [mip.width, mip.height], &mip.bytes);
    }
    Ok(whole_view(&made))
}
