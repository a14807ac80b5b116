//! Image processing for maps, which keeps tiling maps tiling.
//!
//! [`Step`] reads an edit as users write it (`blur=0.002`, `max=other.png`), and [`apply_steps`],
//! [`apply_steps_to_color`] and [`apply_steps_to_normals`] apply a list of them. The other functions are the edits
//! themselves: they work on one number per texel, with lengths in texels. [`Wrap`](relievo_map::Wrap) says what lies beyond the border: `Repeat` for maps that tile.

mod apply;
mod combine;
mod error;
mod filter;
mod orientation;
mod resize;
mod step;
mod tone;

pub use apply::{apply_steps, apply_steps_to_color, apply_steps_to_normals};
pub use combine::{Combine, combine, masked};
pub use error::{EditError, MAX_MEDIAN};
pub use filter::{blur, deband, median, sharpen};
pub use orientation::{Orientation, reoriented, reoriented_normals};
pub use resize::resize;
pub(crate) use resize::{add_resized, resized};
pub use step::{OtherMap, Step, StepError, StepSyntax};
pub use tone::{curve, invert, levels};
