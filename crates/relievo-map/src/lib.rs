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
//!                                ├──▶ MapSet: the maps of one material
//!                                └──▶ one from another: normals ⇄ heights, occlusion, bent normals, curvature
//! ```
//!
//! Texel (0, 0) is the top-left one; rows run downwards, as v does in glTF. Texel centres lie at `(i + 0.5) / size`.
//!
//! ```no_run
//! use std::path::Path;
//! use relievo_map::{Limits, White, read_folder, read_height, write_height};
//!
//! # fn main() -> Result<(), relievo_map::MapError> {
//! // All maps of a material, by the names of its files.
//! let bricks = read_folder(Path::new("textures/bricks102"), &Limits::default())?;
//! for note in &bricks.notes {
//!     eprintln!("{note}");
//! }
//! // One map; a depth map becomes a height map.
//! let stone = read_height(Path::new("stone_depth.tif"), White::Deep, &Limits::default())?;
//! write_height(Path::new("stone_height.png"), &stone.map)?;
//! # Ok(())
//! # }
//! ```

mod atomic;
mod convert;
mod decode;
mod error;
mod file;
mod folder;
mod format;
mod grid;
mod limits;
mod maps;
mod mips;
mod quantise;
mod raster;
mod read;
mod scatter;
mod suffix;
mod wrap;
mod write;

pub use atomic::write_atomic;
pub use convert::{
    Border, HeightFromNormal, IntegrateOptions, Kernel, OcclusionOptions, ambient_occlusion, bent_normals, curvature,
    height_to_normal, normal_to_height, periodic,
};
pub use error::MapError;
pub use folder::{FolderMaps, find_maps, read_folder};
pub use grid::{Grid, GridError};
pub use limits::Limits;
pub use maps::{ColorEncoding, ColorMap, HeightMap, MapSet, NormalMap, ScalarMap, linear_to_srgb, srgb_to_linear};
pub use mips::{MipMap, Texel};
pub use quantise::{dequantise8, dequantise16, quantise8, quantise16};
pub use read::{
    Channel, Loaded, NormalY, White, decode_color, decode_height, decode_normal, decode_scalar, read_color,
    read_height, read_normal, read_scalar,
};
pub use wrap::Wrap;
pub use write::{
    Bits, FileTexel, encode_png, write_color, write_exr, write_height, write_normal, write_picture, write_png8,
    write_png16, write_scalar,
};
