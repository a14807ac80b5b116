use relievo_map::Grid;

use super::error::GpuError;
use super::guard::guarded;
use super::readback::read_texture;
use super::tier::Tier;
use super::timer::Timer;
use super::wgpu_util::{check_size, texture_descriptor, whole_view};

/// A texture to draw into, read back and time where there is no window.
#[derive(Debug)]
pub struct Offscreen {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    #[cfg_attr(not(feature = "renderer"), allow(dead_code))]
    pub(crate) timer: Option<Timer>,
}

impl Offscreen {
    /// Makes a texture of this size in pixels. `format` has four 8-bit channels: `Rgba8Unorm` or `Bgra8Unorm`, with or
    /// without `Srgb`.
    ///
    /// # Errors
    /// If the format is another, the size is 0 or over the device's limit, or the device fails.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        [width, height]: [u32; 2],
        format: wgpu::TextureFormat,
    ) -> Result<Self, GpuError> {
        use wgpu::TextureFormat::{Bgra8Unorm, Rgba8Unorm};
        if !matches!(format.remove_srgb_suffix(), Rgba8Unorm | Bgra8Unorm) {
            let text = format!("{format:?} is not read back: use Rgba8Unorm or Bgra8Unorm");
            return Err(GpuError::InvalidArgument(text));
        }
        if width == 0 || height == 0 {
            return Err(GpuError::InvalidArgument(format!("a picture of {width}×{height} pixels is not possible")));
        }
        check_size(device, "the picture", width, height)?;
        guarded(device, || {
            let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
            let texture =
                device.create_texture(&texture_descriptor("relievo offscreen", [width, height], format, usage));
            let view = whole_view(&texture);
            let timer = (Tier::of(device) == Tier::Full).then(|| Timer::new(device, queue));
            Ok(Self { device: device.clone(), queue: queue.clone(), texture, view, timer })
        })
    }

    /// View to draw into, for those who draw themselves.
    #[must_use]
    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
    }

    /// Draws over the whole picture in one render pass, which begins with transparent black, and submits it.
    ///
    /// # Errors
    /// If the device fails.
    pub fn render_pass(&self, draw: impl FnOnce(&mut wgpu::RenderPass<'_>)) -> Result<(), GpuError> {
        guarded(&self.device, || {
            let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            draw(&mut encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("relievo offscreen"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &self.view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), ..Default::default() },
                })],
                ..wgpu::RenderPassDescriptor::default()
            }));
            self.queue.submit([encoder.finish()]);
            Ok(())
        })
    }

    /// Width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        [self.texture.width(), self.texture.height()]
    }

    /// Reads the picture, once everything submitted so far is done: red, green and blue as they stand in the texture. Blocks.
    ///
    /// # Errors
    /// If the device fails.
    pub fn pixels(&self) -> Result<Grid<[u8; 3]>, GpuError> {
        read_rgb(&self.device, &self.queue, &self.texture)
    }
}

/// Reads a texture with four 8-bit channels (`Rgba8Unorm` or `Bgra8Unorm`, with or without `Srgb`) and usage COPY_SRC: red,
/// green and blue as they stand in it. Blocks.
///
/// # Errors
/// If the device fails, or the texture has another format.
pub fn read_rgb(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texture: &wgpu::Texture,
) -> Result<Grid<[u8; 3]>, GpuError> {
    let format = texture.format().remove_srgb_suffix();
    let bytes = read_texture(device, queue, texture)?;
    let pixel: fn(&[u8]) -> [u8; 3] = match format {
        wgpu::TextureFormat::Bgra8Unorm => |texel| [texel[2], texel[1], texel[0]],
        wgpu::TextureFormat::Rgba8Unorm => |texel| [texel[0], texel[1], texel[2]],
        other => {
            let text = format!("{other:?} is not read as colours: use Rgba8Unorm or Bgra8Unorm");
            return Err(GpuError::InvalidArgument(text));
        }
    };
    Grid::new(texture.width(), texture.height(), bytes.chunks_exact(4).map(pixel).collect())
        .map_err(|error| GpuError::Device(error.to_string()))
}
