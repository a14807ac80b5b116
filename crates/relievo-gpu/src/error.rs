use std::future::Future;
use std::pin::pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::{Context, Poll, Waker};

use thiserror::Error;

use crate::ComposeError;

/// Why the GPU could not do its part.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum GpuError {
    /// The machine has no adapter.
    #[error(
        "no GPU adapter was found: install a driver (on Debian and Ubuntu `apt-get install mesa-vulkan-drivers libvulkan1` \
         gives an adapter in software), or draw on the CPU"
    )]
    NoAdapter,
    /// No adapter has the name that was asked for.
    #[error("no GPU adapter's name contains \"{wanted}\"; there are: {}", known.join("; "))]
    NoSuchAdapter {
        /// What was asked for.
        wanted: String,
        /// The names of those there are.
        known: Vec<String>,
    },
    /// A map is larger than the device's textures can be.
    #[error(
        "{what} has {width}×{height} texels, but this device's textures have at most {max} on a side: \
         make the map smaller, or request the device with `Limits::using_resolution(adapter.limits())`"
    )]
    TextureTooLarge {
        /// Which map.
        what: String,
        /// Texels per row.
        width: u32,
        /// Rows.
        height: u32,
        /// The device's limit.
        max: u32,
    },
    /// A buffer is larger than the device's buffers can be.
    #[error(
        "{what} take {bytes} bytes, but this device's buffers have at most {max}: draw fewer or coarser meshes, or smaller maps"
    )]
    BufferTooLarge {
        /// What was to be stored.
        what: String,
        /// Its size.
        bytes: u64,
        /// The device's limit.
        max: u64,
    },
    /// The device cannot compute.
    #[error("this device has no compute shaders (WebGL2-class): march on the CPU, or request another adapter")]
    NoCompute,
    /// The memory of the device is full.
    #[error("the device is out of memory ({0}): use smaller maps or a smaller picture")]
    OutOfMemory(String),
    /// The device is lost, or refused what it was asked.
    #[error("the device failed: {0}")]
    Device(String),
    /// The scene breaks a promise of `relievo-scene`.
    #[error("the scene cannot be drawn: {0}")]
    InvalidScene(#[from] relievo_scene::InvalidScene),
    /// The scene asks for more than the renderer can do.
    #[error("the scene cannot be drawn: {0}")]
    Scene(String),
    /// Shader modules do not fit together.
    #[error(transparent)]
    Compose(#[from] ComposeError),
}

/// Does what may fail on the device, and gives the failure as an error; without this wgpu would panic.
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

/// Whether the device is gone. No call says so, and errors on it go to a callback that is the device's owner's: but memory
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

/// What a future has to say already.
fn known<T>(future: impl Future<Output = Option<T>>) -> Option<T> {
    match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(value) => value,
        Poll::Pending => None,
    }
}
