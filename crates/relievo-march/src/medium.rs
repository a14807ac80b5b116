//! The relief as a medium instead of a wall: light is absorbed and scattered below the surface.

mod cell_layer;
mod optical_depth;
mod phase;

pub use optical_depth::{MAX_OPTICAL_DEPTH, Medium, MediumRay, OpticalDepth, optical_depth, scatter_distances};
pub use phase::henyey_greenstein;
