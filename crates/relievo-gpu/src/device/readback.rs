//! The way from the device to the host.

use std::sync::mpsc;
use std::time::Duration;

use super::error::GpuError;
use super::guard::guarded;

/// Limit of the time that the answer may take once the device is done: another thread that polled may be busy with other answers.
const ANSWER: Duration = Duration::from_secs(60);

/// Size of the parts that a picture comes back in, or one row: a buffer for all of it could be over the device's limit.
const PART: u64 = 64 << 20;

/// Waits for everything submitted so far.
pub(crate) fn wait(device: &wgpu::Device) -> Result<(), GpuError> {
    let done = device.poll(wgpu::PollType::wait_indefinitely());
    done.map(drop).map_err(|error| GpuError::Device(error.to_string()))
}

/// Reads every texel of a texture with usage COPY_SRC, row by row without gaps, once everything submitted so far is done.
/// Blocks.
///
/// # Errors
/// If the device fails.
pub fn read_texture(device: &wgpu::Device, queue: &wgpu::Queue, texture: &wgpu::Texture) -> Result<Vec<u8>, GpuError> {
    let (width, height) = (texture.width(), texture.height());
    let row = width * texture.format().block_copy_size(None).unwrap_or(4);
    // Rows in buffers lie at multiples of what the copy asks for.
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let rows_at_once =
        (PART.min(device.limits().max_buffer_size) / u64::from(padded)).clamp(1, u64::from(height)) as u32;
    let mut bytes = Vec::with_capacity(row as usize * height as usize);
    for first in (0..height).step_by(rows_at_once as usize) {
        let rows = rows_at_once.min(height - first);
        let part = guarded(device, || {
            let buffer = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("relievo readback"),
                size: u64::from(padded) * u64::from(rows),
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                mapped_at_creation: false,
            });
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let from = wgpu::TexelCopyTextureInfo {
                origin: wgpu::Origin3d { x: 0, y: first, z: 0 },
                ..texture.as_image_copy()
            };
            let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: None };
            let size = wgpu::Extent3d { width, height: rows, depth_or_array_layers: 1 };
            encoder.copy_texture_to_buffer(from, wgpu::TexelCopyBufferInfo { buffer: &buffer, layout }, size);
            queue.submit([encoder.finish()]);
            read_buffer(device, &buffer)
        })?;
        bytes.extend(part.chunks_exact(padded as usize).flat_map(|padded| &padded[..row as usize]));
    }
    Ok(bytes)
}

/// Reads the bytes of a buffer with usage MAP_READ, once the device has done everything submitted so far. Blocks.
pub(crate) fn read_buffer(device: &wgpu::Device, buffer: &wgpu::Buffer) -> Result<Vec<u8>, GpuError> {
    let (sender, receiver) = mpsc::channel();
    // The receiver is gone only after an error that has been given already.
    buffer.map_async(wgpu::MapMode::Read, .., move |result| drop(sender.send(result)));
    wait(device)?;
    match receiver.recv_timeout(ANSWER) {
        Ok(Ok(())) => {}
        Ok(Err(error)) => return Err(GpuError::Device(error.to_string())),
        Err(_) => return Err(GpuError::Device("the device gave no answer when its memory was read".to_owned())),
    }
    let bytes = buffer.get_mapped_range(..).map_err(|error| GpuError::Device(error.to_string()))?.to_vec();
    buffer.unmap();
    Ok(bytes)
}
