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
//! # Features
//! - **`io`** (default): image files and material folders: PNG, JPEG, TIFF, OpenEXR, Radiance HDR, TGA, BMP and WebP
//!   in, PNG and OpenEXR out, whole or not at all.
//! - **`convert`** (default): maps from maps: normals ⇄ heights, ambient occlusion, bent normals, curvature, tiling.
//!
//! Without them the types remain, with no dependency and no access to files: [`Grid`], [`HeightMap`], [`NormalMap`],
//! [`ColorMap`], [`ScalarMap`], [`MapSet`], [`MipMap`], [`Wrap`], the sRGB curve and quantization.
//!
#![cfg_attr(feature = "io", doc = "```no_run")]
#![cfg_attr(not(feature = "io"), doc = "```ignore")]
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

#![cfg_attr(docsrs, feature(doc_cfg))]

#[cfg(feature = "convert")]
mod convert;
#[cfg(feature = "io")]
mod io;
#[cfg(feature = "io")]
mod sets;
mod types;

#[cfg(feature = "convert")]
pub use convert::{
    Border, DerivativeKernel, HeightFromNormal, IntegrateOptions, OcclusionOptions, ambient_occlusion, bent_normals,
    curvature, height_to_normal, normal_to_height, periodic,
};
#[cfg(feature = "io")]
pub use io::{
    BitDepth, FileTexel, FilmFormat, FilmShape, IMAGE_EXTENSIONS, Limits, Loaded, MapError, decode_color,
    decode_height, decode_normal, decode_scalar, encode_png, read_color, read_height, read_normal, read_scalar,
    write_atomic, write_color, write_exr, write_film, write_height, write_normal, write_picture, write_png8,
    write_png16, write_scalar,
};
#[cfg(feature = "io")]
pub use sets::{FolderMaps, find_maps, read_folder};
pub use types::{
    Channel, ColorEncoding, ColorMap, Grid, GridError, GridId, HeightMap, MapSet, MipMap, NormalMap, NormalY,
    ScalarMap, Texel, White, Wrap, dequantize8, dequantize16, linear_to_srgb, quantize8, quantize16, srgb_to_linear,
};

/// The examples of the README.
#[cfg(all(doctest, feature = "io", feature = "convert"))]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
