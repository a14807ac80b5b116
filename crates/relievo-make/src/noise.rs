//! Noise that repeats exactly after one texture repeat.
//!
//! [`Noise`] is one octave, [`Fractal`] a sum of octaves. `random` and `periodic` have the hashes and the wrapping of cells,
//! `lattice` and `fbm` the row-wise gradient noise of the built-in materials.

mod basis;
mod fbm;
mod fractal;
mod lattice;
mod periodic;
mod random;
mod slices;

pub(crate) use basis::Octave;
pub use basis::{Basis, Noise};
pub(crate) use fbm::{Fbm, visible_fraction};
pub use fractal::{Fractal, FractalKind};
pub(crate) use lattice::GradientNoise;
pub(crate) use periodic::wrap_unit;
pub(crate) use random::{HashRng, hash3, unit_float};
pub(crate) use slices::Slices;
