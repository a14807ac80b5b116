//! Devices, their errors and times, and the way back to the host.

mod error;
mod gpu;
mod guard;
mod offscreen;
mod readback;
mod tier;
mod timer;
pub(crate) mod wgpu_util;

pub use error::GpuError;
pub use gpu::{AdapterChoice, Gpu, adapter_name, adapters, interface_name, is_real};
pub(crate) use guard::guarded;
pub use offscreen::{Offscreen, read_rgb};
pub use readback::read_texture;
pub(crate) use readback::{read_buffer, wait};
pub use tier::Tier;
pub(crate) use timer::Timer;
pub use timer::{FrameTime, Timestamps};
