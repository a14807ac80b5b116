//! Marching and timing of rays: backends, rays, and the stopwatch.

mod backend;
#[cfg(feature = "gpu")]
mod gpu;
mod rays;
mod stopwatch;

pub use backend::MarchBackend;
pub(crate) use backend::with_cones;
#[cfg(feature = "gpu")]
pub use gpu::GpuMarchBackend;
pub(crate) use rays::{TILE_RAYS, tiles};
pub(crate) use stopwatch::Stopwatch;
