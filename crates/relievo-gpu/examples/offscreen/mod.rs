//! A texture to draw into, and its picture in a file: what a window would be.

use std::error::Error;
use std::sync::mpsc;

/// A texture that can be drawn into and saved.
pub(crate) struct Picture {
    texture: wgpu::Texture,
    pub(crate) view: wgpu::TextureView,
}

impl Picture {
    pub(crate) fn new(device: &wgpu::Device, [width, height]: [u32; 2], format: wgpu::TextureFormat) -> Self {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Self { texture, view }
    }

    /// Waits for what was submitted, and writes the picture. Its width must be a multiple of 64.
    pub(crate) fn save(&self, device: &wgpu::Device, queue: &wgpu::Queue, path: &str) -> Result<(), Box<dyn Error>> {
        let (width, height) = (self.texture.width(), self.texture.height());
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(width * height * 4),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(width * 4), rows_per_image: None };
        let target = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(self.texture.as_image_copy(), target, self.texture.size());
        queue.submit([encoder.finish()]);
        let (sender, receiver) = mpsc::channel();
        buffer.map_async(wgpu::MapMode::Read, .., move |result| drop(sender.send(result)));
        device.poll(wgpu::PollType::wait_indefinitely())?;
        receiver.recv()??;
        image::save_buffer(path, &buffer.get_mapped_range(..)?, width, height, image::ColorType::Rgba8)?;
        Ok(())
    }
}
