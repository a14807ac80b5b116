//! A scene drawn offscreen, read back; and what is left behind when it is not as expected.

use std::path::PathBuf;

use relievo_gpu::{Offscreen, Renderer, RendererOptions};
use relievo_map::Grid;
use relievo_scene::Scene;

use super::device::Gpu;

/// The picture in the scene's size.
pub fn draw(gpu: &Gpu, scene: &Scene, format: wgpu::TextureFormat) -> Grid<[u8; 3]> {
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue, scene, format, &RendererOptions::default()).unwrap();
    draw_with(gpu, &mut renderer, [scene.image.width, scene.image.height], format)
}

/// One more picture by the same renderer.
pub fn draw_with(gpu: &Gpu, renderer: &mut Renderer, size: [u32; 2], format: wgpu::TextureFormat) -> Grid<[u8; 3]> {
    let offscreen = Offscreen::new(&gpu.device, &gpu.queue, size, format).unwrap();
    offscreen.draw(renderer).unwrap();
    offscreen.pixels().unwrap()
}

/// Every texel of a texture whose texels have four bytes.
pub fn texels(gpu: &Gpu, texture: &wgpu::Texture, aspect: wgpu::TextureAspect) -> Vec<[u8; 4]> {
    let (width, height, size) = (texture.width(), texture.height(), texture.size());

    let row = (width * 4).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(row * height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
    let target = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(wgpu::TexelCopyTextureInfo { aspect, ..texture.as_image_copy() }, target, size);
    gpu.queue.submit([encoder.finish()]);
    let (sender, receiver) = std::sync::mpsc::channel();
    buffer.map_async(wgpu::MapMode::Read, .., move |result| sender.send(result).unwrap());
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    receiver.recv().unwrap().unwrap();
    let bytes = buffer.get_mapped_range(..).unwrap();
    let rows = bytes.chunks_exact(row as usize);
    rows.flat_map(|row| row[..width as usize * 4].chunks_exact(4)).map(|b| [b[0], b[1], b[2], b[3]]).collect()
}

/// Leaves expected, got and their difference (times eight) under the target folder.
pub fn report(name: &str, expected: &Grid<[u8; 3]>, got: &Grid<[u8; 3]>) {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("pictures");
    std::fs::create_dir_all(&folder).unwrap();
    let difference = Grid::from_fn(got.width(), got.height(), |x, y| {
        let (a, b) = (expected.get(x, y), got.get(x, y));
        [0, 1, 2].map(|k| a[k].abs_diff(b[k]).saturating_mul(8))
    });
    for (what, picture) in [("expected", expected), ("got", got), ("difference", &difference)] {
        let bytes: Vec<u8> = picture.texels().iter().flatten().copied().collect();
        let path = folder.join(format!("{name}-{what}.png"));
        image::save_buffer(&path, &bytes, picture.width(), picture.height(), image::ColorType::Rgb8).unwrap();
        println!("  {}", path.display());
    }
}
