//! Patterns of the plane: Voronoi cells, masonry bonds and signed distances of shapes.

mod masonry;
pub mod sdf;
mod voronoi;

pub use masonry::{Bond, BrickPoint, Masonry};
pub(crate) use voronoi::border_random;
pub use voronoi::{CellPoint, Voronoi};
