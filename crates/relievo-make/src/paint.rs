//! Strokes painted into a height map: cracks and tracks by hand.
//!
//! Strokes come from an SVG drawing ([`strokes_from_svg`]) or a small stroke file ([`strokes_from_file`]); [`paint`] carves
//! them into heights, and continues them at the other side where they leave the map.

mod error;
mod painter;
mod stroke;
mod stroke_file;
mod svg;

pub use error::PaintError;
pub use painter::paint;
pub use stroke::{Brush, Profile, Stroke};
pub use stroke_file::strokes_from_file;
pub use svg::strokes_from_svg;
