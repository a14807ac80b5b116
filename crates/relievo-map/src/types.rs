//! Maps in memory: grids of texels, their meanings, addressing, filtering and quantization. No files, no dependencies.

mod color;
mod conventions;
mod grid;
mod maps;
mod mip_map;
mod quantize;
mod sample;
mod variance_mips;
mod wrap;

pub use color::{ColorEncoding, ColorMap, linear_to_srgb, srgb_to_linear};
pub use conventions::{Channel, NormalY, White};
pub use grid::{Grid, GridError, GridId};
pub use maps::{HeightMap, MapSet, NormalMap, ScalarMap};
pub use mip_map::MipMap;
pub use quantize::{dequantize8, dequantize16, quantize8, quantize16};
pub use sample::Texel;
pub use wrap::Wrap;
