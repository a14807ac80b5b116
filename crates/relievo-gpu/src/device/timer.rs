//! Times by the device's own clock.

use std::time::Duration;

use super::error::GpuError;
use super::guard::guarded;
use super::readback::read_buffer;

/// Time that a frame took.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameTime {
    /// From the first to the last pass by the device's own clock; `None` below [`crate::Tier::Full`].
    pub gpu: Option<Duration>,
    /// From recording the frame to its end, as the program sees it.
    pub wall: Duration,
}

/// Timestamps around all that is drawn for a picture, shadow maps included where they had to be drawn anew. The device needs
/// the feature TIMESTAMP_QUERY.
#[derive(Clone, Copy, Debug)]
pub struct Timestamps<'a> {
    /// Of type Timestamp.
    pub set: &'a wgpu::QuerySet,
    /// Written before the first pass.
    pub begin: u32,
    /// Written after the last pass.
    pub end: u32,
}

/// Two timestamps of the device, and the buffers that bring them to the host.
#[derive(Debug)]
pub(crate) struct Timer {
    set: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    staging: wgpu::Buffer,
    /// Nanoseconds per tick.
    period: f32,
}

impl Timer {
    const BYTES: u64 = 2 * wgpu::QUERY_SIZE as u64;

    /// Makes a timer on a device of [`crate::Tier::Full`].
    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        let buffer = |usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("relievo timer"),
                size: Self::BYTES,
                usage,
                mapped_at_creation: false,
            })
        };
        Self {
            set: device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("relievo timer"),
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            }),
            resolved: buffer(wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
            staging: buffer(wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ),
            period: queue.get_timestamp_period(),
        }
    }

    /// Timestamps that a frame writes.
    #[cfg(feature = "renderer")]
    pub(crate) fn timestamps(&self) -> Timestamps<'_> {
        Timestamps { set: &self.set, begin: 0, end: 1 }
    }

    /// Timestamps that a compute pass writes.
    pub(crate) fn compute_pass(&self) -> wgpu::ComputePassTimestampWrites<'_> {
        wgpu::ComputePassTimestampWrites {
            query_set: &self.set,
            beginning_of_pass_write_index: Some(0),
            end_of_pass_write_index: Some(1),
        }
    }

    /// Reads the time between the two that were written last. Blocks.
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
