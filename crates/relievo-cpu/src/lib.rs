//! Draws a scene on the CPU, on all cores: the backend that is always there, and the reference for all others.
//!
//! ```text
//!  Scene ──Renderer::new──▶ world: triangles in a BVH, maps with mip levels, displaced grids
//!                             │
//!   pixel ──ray──▶ polygon ──march──▶ surface point ──lights, shadows──▶ colour, AOVs
//!                             │ miss (clipped): on to what lies behind
//! ```
//!
//! Every pixel depends on the scene alone, so the picture is the same with one thread or many.

mod bvh;
mod camera;
mod display;
mod environment;
mod error;
mod frame;
mod light;
mod material;
mod mean_normal;
mod reflection;
mod render;
mod surface;
mod triangle;
mod world;

pub use error::RenderError;
pub use relievo_scene::{Aovs, Frame};
pub use render::{Precision, RenderOptions, Renderer};
