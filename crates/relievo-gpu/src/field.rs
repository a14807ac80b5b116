//! Height maps on the device.

mod bindings;
mod cone_textures;
mod height_mips;
mod height_texture;
mod layout;
mod live_heights;
mod pyramid_kernels;
mod pyramid_layout;
mod upload;

pub use bindings::texture_layout_entries;
pub use height_texture::HeightTexture;
pub use live_heights::{LiveHeights, Quantization};
