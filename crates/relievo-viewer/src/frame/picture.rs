//! A texture beside the window, for screenshots and for frames that nobody sees.

use std::time::Duration;

use relievo_gpu::{GpuError, read_rgb};
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

    /// Reads the picture as display RGB.
    pub(crate) fn read(&self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Grid<[u8; 3]>, GpuError> {
        wait(device)?;
        read_rgb(device, queue, &self.texture)
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
