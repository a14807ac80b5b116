use std::time::{Duration, Instant};

use relievo_map::Grid;

use crate::error::guarded;
use crate::height_texture::check_size;
use crate::readback::{read_buffer, read_texture, wait};
use crate::{GpuError, Renderer, Target, Tier, Timestamps};

/// A texture to draw into, read back and time where there is no window.
#[derive(Debug)]
pub struct Offscreen {
    device: wgpu::Device,
    queue: wgpu::Queue,
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    clock: Option<Clock>,
}

/// How long a frame took.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameTime {
    /// From the first to the last render pass by the device's own clock; `None` below [`Tier::Full`].
    pub gpu: Option<Duration>,
    /// From recording the frame to its end, as the program sees it.
    pub wall: Duration,
}

impl Offscreen {
    /// A texture of this size in pixels. `format` has four 8-bit channels: `Rgba8Unorm` or `Bgra8Unorm`, with or without
    /// `Srgb`.
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
            return Err(GpuError::Scene(format!("{format:?} is not read back: use Rgba8Unorm or Bgra8Unorm")));
        }
        if width == 0 || height == 0 {
            return Err(GpuError::Scene(format!("a picture of {width}×{height} pixels is not possible")));
        }
        check_size(device, "the picture", width, height)?;
        guarded(device, || {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some("relievo offscreen"),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
                view_formats: &[],
            });
            let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
            let clock = (Tier::of(device) == Tier::Full).then(|| Clock::new(device, queue));
            Ok(Self { device: device.clone(), queue: queue.clone(), texture, view, clock })
        })
    }

    /// What to draw into, for those who draw themselves.
    #[must_use]
    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
    }

    /// Width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        [self.texture.width(), self.texture.height()]
    }

    /// Draws a frame, with a renderer made for this format. Returns when the work is submitted.
    ///
    /// # Errors
    /// As [`Renderer::draw`].
    pub fn draw(&self, renderer: &mut Renderer) -> Result<(), GpuError> {
        renderer.draw(&Target::new(&self.view, self.size()))
    }

    /// Draws a frame and waits until it is done.
    ///
    /// # Errors
    /// As [`Renderer::draw`].
    pub fn time(&self, renderer: &mut Renderer) -> Result<FrameTime, GpuError> {
        // Nothing of what was submitted before is to be counted.
        wait(&self.device)?;
        let start = Instant::now();
        let timestamps = self.clock.as_ref().map(Clock::timestamps);
        renderer.draw(&Target { timestamps, ..Target::new(&self.view, self.size()) })?;
        wait(&self.device)?;
        let wall = start.elapsed();
        let gpu = self.clock.as_ref().map(|clock| clock.elapsed(&self.device, &self.queue)).transpose()?;
        Ok(FrameTime { gpu, wall })
    }

    /// The picture, once everything submitted so far is done: red, green and blue as they stand in the texture. Blocks.
    ///
    /// # Errors
    /// If the device fails.
    pub fn pixels(&self) -> Result<Grid<[u8; 3]>, GpuError> {
        let bytes = read_texture(&self.device, &self.queue, &self.texture)?;
        let blue_first = self.texture.format().remove_srgb_suffix() == wgpu::TextureFormat::Bgra8Unorm;
        let pixel =
            |texel: &[u8]| if blue_first { [texel[2], texel[1], texel[0]] } else { [texel[0], texel[1], texel[2]] };
        let [width, height] = self.size();
        Grid::new(width, height, bytes.chunks_exact(4).map(pixel).collect())
            .map_err(|error| GpuError::Device(error.to_string()))
    }
}

/// Two timestamps of the device, and the way to the host.
#[derive(Debug)]
pub(crate) struct Clock {
    set: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    staging: wgpu::Buffer,
    /// Nanoseconds per tick.
    period: f32,
}

impl Clock {
    const BYTES: u64 = 2 * wgpu::QUERY_SIZE as u64;

    /// For devices of [`Tier::Full`].
    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        let buffer = |usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("relievo clock"),
                size: Self::BYTES,
                usage,
                mapped_at_creation: false,
            })
        };
        Self {
            set: device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("relievo clock"),
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            }),
            resolved: buffer(wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
            staging: buffer(wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ),
            period: queue.get_timestamp_period(),
        }
    }

    /// Where a frame writes its times.
    fn timestamps(&self) -> Timestamps<'_> {
        Timestamps { set: &self.set, begin: 0, end: 1 }
    }

    /// Where a compute pass writes its times.
    pub(crate) fn of_compute_pass(&self) -> wgpu::ComputePassTimestampWrites<'_> {
        wgpu::ComputePassTimestampWrites {
            query_set: &self.set,
            beginning_of_pass_write_index: Some(0),
            end_of_pass_write_index: Some(1),
        }
    }

    /// The time between the two that were written last. Blocks.
    pub(crate) fn elapsed(&self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Duration, GpuError> {
        let bytes = guarded(device, || {
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            encoder.resolve_query_set(&self.set, 0..2, &self.resolved, 0);
            encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.staging, 0, None);
            queue.submit([encoder.finish()]);
            read_buffer(device, &self.staging)
        })?;
        let tick = |k: usize| bytemuck::pod_read_unaligned::<u64>(&bytes[8 * k..8 * k + 8]);
        Ok(Duration::from_nanos((tick(1).saturating_sub(tick(0)) as f64 * f64::from(self.period)) as u64))
    }
}
