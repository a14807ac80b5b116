//! A texture beside the window, for screenshots and for frames that nobody sees.

use std::sync::mpsc;
use std::time::Duration;

use relievo_gpu::GpuError;
use relievo_map::Grid;

/// Longest time for a frame, after which the device is taken for stuck.
pub(crate) const PATIENCE: Duration = Duration::from_secs(120);

pub(crate) struct Picture {
    texture: wgpu::Texture,
    pub(crate) view: wgpu::TextureView,
}

impl Picture {
    /// `format` is one of [`FORMATS`].
    pub(crate) fn new(device: &wgpu::Device, [width, height]: [u32; 2], format: wgpu::TextureFormat) -> Self {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("relievo viewer"),
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

    pub(crate) fn size(&self) -> [u32; 2] {
        [self.texture.width(), self.texture.height()]
    }

    /// Reads the picture back, as display RGB.
    pub(crate) fn read(&self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Grid<[u8; 3]>, GpuError> {
        let [width, height] = self.size();
        let row = (width * 4).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("relievo screenshot"),
            size: u64::from(row) * u64::from(height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        let target = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(self.texture.as_image_copy(), target, self.texture.size());
        queue.submit([encoder.finish()]);
        let (sender, receiver) = mpsc::channel();
        buffer.map_async(wgpu::MapMode::Read, .., move |result| drop(sender.send(result)));
        wait(device)?;
        let failed = |error: String| GpuError::Device(error);
        receiver
            .recv_timeout(PATIENCE)
            .map_err(|_| failed("it gave no answer when a picture was read".to_owned()))?
            .map_err(|error| failed(error.to_string()))?;
        let bytes = buffer.get_mapped_range(..).map_err(|error| failed(error.to_string()))?;
        let swapped = matches!(self.texture.format().remove_srgb_suffix(), wgpu::TextureFormat::Bgra8Unorm);
        let pixels = bytes
            .chunks_exact(row as usize)
            .flat_map(|row| row.chunks_exact(4).take(width as usize))
            .map(|texel| if swapped { [texel[2], texel[1], texel[0]] } else { [texel[0], texel[1], texel[2]] })
            .collect();
        Grid::new(width, height, pixels).map_err(|error| failed(error.to_string()))
    }
}

/// Formats that can be drawn to and read, best first: those that encode sRGB blend and filter right.
pub(crate) const FORMATS: [wgpu::TextureFormat; 4] = [
    wgpu::TextureFormat::Bgra8UnormSrgb,
    wgpu::TextureFormat::Rgba8UnormSrgb,
    wgpu::TextureFormat::Bgra8Unorm,
    wgpu::TextureFormat::Rgba8Unorm,
];

/// Waits until the device has done all it was given.
pub(crate) fn wait(device: &wgpu::Device) -> Result<(), GpuError> {
    let all = wgpu::PollType::Wait { submission_index: None, timeout: Some(PATIENCE) };
    match device.poll(all) {
        Ok(_) => Ok(()),
        Err(wgpu::PollError::Timeout) => {
            let seconds = PATIENCE.as_secs();
            Err(GpuError::Device(format!("it took over {seconds} s for one frame: draw a smaller picture")))
        }
        Err(error) => Err(GpuError::Device(error.to_string())),
    }
}
