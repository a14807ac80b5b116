//! Frame times by the device's own clock.

use std::sync::mpsc;

use relievo_gpu::{Gpu, GpuError, Timestamps};

use crate::frame::picture::wait;

/// Two timestamps of 8 bytes.
const BYTES: u64 = 16;

pub(crate) struct Timer {
    set: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    readable: wgpu::Buffer,
    /// Nanoseconds per tick.
    period: f64,
}

impl Timer {
    /// `None` if the device has no clock.
    pub(crate) fn new(gpu: &Gpu) -> Option<Self> {
        let device = &gpu.device;
        if !device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return None;
        }
        let buffer = |usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("relievo timestamps"),
                size: BYTES,
                usage,
                mapped_at_creation: false,
            })
        };
        Some(Self {
            set: device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("relievo frame"),
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            }),
            resolved: buffer(wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
            readable: buffer(wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ),
            period: f64::from(gpu.queue.get_timestamp_period()),
        })
    }

    /// The queries for a frame's begin and end.
    pub(crate) fn timestamps(&self) -> Timestamps<'_> {
        Timestamps { set: &self.set, begin: 0, end: 1 }
    }

    /// Milliseconds of the frame that was drawn last. Waits for it.
    pub(crate) fn read(&self, gpu: &Gpu) -> Result<Option<f64>, GpuError> {
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.resolve_query_set(&self.set, 0..2, &self.resolved, 0);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.readable, 0, BYTES);
        gpu.queue.submit([encoder.finish()]);
        let (sender, receiver) = mpsc::channel();
        self.readable.map_async(wgpu::MapMode::Read, .., move |result| drop(sender.send(result)));
        wait(&gpu.device)?;
        // A clock that does not answer is no reason to stop.
        if !matches!(receiver.try_recv(), Ok(Ok(()))) {
            return Ok(None);
        }
        let Ok(bytes) = self.readable.get_mapped_range(..).map(|range| range.to_vec()) else { return Ok(None) };
        self.readable.unmap();
        let ticks: Vec<u64> =
            bytes.chunks_exact(8).filter_map(|bytes| Some(u64::from_ne_bytes(bytes.try_into().ok()?))).collect();
        let &[begin, end] = ticks.as_slice() else { return Ok(None) };
        Ok(end.checked_sub(begin).map(|ticks| ticks as f64 * self.period * 1e-6).filter(|&ms| ms > 0.0))
    }
}
