//! Typed texture maps and their conventions.
//!
//! Everything that Relievo draws starts as a map: a rectangle of texels *with a meaning*. This crate knows the meanings
//! (height, normal, colour, roughness, …), keeps one convention for each in memory, and carries maps in and out of
//! image files. It knows nothing of rays, scenes or GPUs.
//!
//! ```text
//!  files ──read──▶ Grid<T> ──▶ HeightMap   f32 in [0,1], white = high
//!                          ──▶ NormalMap   xyz, +Y up (OpenGL, glTF)
//!                          ──▶ ColorMap    RGBA, as stored, tagged sRGB or linear
//!                          ──▶ ScalarMap   f32 in [0,1]: roughness, metallic, ambient occlusion
//!                                │
//!                                └──▶ MapSet: the maps of one material
//! ```
//!
//! Texel (0, 0) is the top-left one; rows run downwards, as v does in glTF. Texel centres lie at `(i + 0.5) / size`.

mod grid;
mod maps;
mod wrap;

pub use grid::{Grid, GridError};
pub use maps::{ColorEncoding, ColorMap, HeightMap, MapSet, NormalMap, ScalarMap, linear_to_srgb, srgb_to_linear};
pub use wrap::Wrap;
