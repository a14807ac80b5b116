//! Draws a scene on the CPU, on all cores: the renderer that works everywhere, and the reference for all others.
//!
//! ```text
//!  Scene ──Renderer::new──▶ world: triangles in a BVH, maps with mip levels, displaced grids
//!                             │
//!   pixel ──ray──▶ polygon ──march──▶ surface point ──lights, shadows──▶ colour, AOVs
//!                             │ miss (clipped): on to what lies behind
//! ```
//!
//! Every pixel depends on the scene alone, so the picture is the same with one thread or many.
//!
//! The phases of a picture are its folders: `geometry` (triangles and their hierarchies), `surface` (view and shadow rays,
//! and the march on each polygon), `shading` (lights, material, reflection).

mod camera;
mod display;
mod error;
mod frame;
mod geometry;
mod options;
mod render;
mod shading;
mod surface;

pub use error::RenderError;
pub use options::{Precision, RenderOptions};
pub use relievo_scene::{Aovs, Frame};
pub use render::{DisplacedSurface, Renderer, VisibleOptions, VisiblePoint};

/// Tests of the example in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExample;
