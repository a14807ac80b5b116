//! The maxima of ever larger blocks of a height map: they let the exact march skip whole blocks at one look.

mod max_pyramid;
mod node;
mod pyramid_field;
mod quantization;
mod region;
mod window_maxima;

pub use max_pyramid::{MaxPyramid, PyramidLevel, TexelRect};
pub use node::Node;
pub(crate) use node::{BITS, SLACK, child_index};
pub use pyramid_field::PyramidField;
pub(crate) use region::highest_in;
pub(crate) use window_maxima::{WindowGrid, WindowMaxima};
