//! Failures of the device as errors.

use std::future::Future;
use std::pin::pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::{Context, Poll, Waker};

use super::error::GpuError;

/// Runs work that may fail on the device, and gives the failure as an error; without this wgpu would panic.
///
/// Where errors arrive later (WebGPU in a browser) the work goes on with what is invalid, which draws nothing.
pub(crate) fn guarded<T>(device: &wgpu::Device, work: impl FnOnce() -> Result<T, GpuError>) -> Result<T, GpuError> {
    if is_lost(device) {
        return Err(GpuError::Device("it is lost; open a new one and make everything on it anew".to_owned()));
    }
    let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let internal = device.push_error_scope(wgpu::ErrorFilter::Internal);
    let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let done = work();
    let errors = [known(validation.pop()), known(internal.pop()), known(memory.pop())];
    match errors.into_iter().flatten().next() {
        None => done,
        Some(wgpu::Error::OutOfMemory { source }) => Err(GpuError::OutOfMemory(source.to_string())),
        Some(error) => Err(GpuError::Device(error.to_string())),
    }
}

/// Returns true if the device is gone. No call says so, and errors on it go to a callback that is the device's owner's: but memory
/// of a lost device cannot be mapped, and that is said at once.
fn is_lost(device: &wgpu::Device) -> bool {
    let refusals = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let probe = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("relievo probe"),
        size: wgpu::MAP_ALIGNMENT,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let refused = Arc::new(AtomicBool::new(false));
    let answer = Arc::clone(&refused);
    probe.map_async(wgpu::MapMode::Read, .., move |result| answer.store(result.is_err(), Ordering::Relaxed));
    known(refusals.pop());
    refused.load(Ordering::Relaxed)
}

/// The value of a future that is ready.
fn known<T>(future: impl Future<Output = Option<T>>) -> Option<T> {
    match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(value) => value,
        Poll::Pending => None,
    }
}
