//! Relief mapping in WGSL.

mod composer;
mod error;
mod modules;
mod permutation;
mod source;
mod texture_bytes;
#[cfg(feature = "translate")]
pub mod translate;
mod uniforms;

pub use composer::Composer;
pub use error::ComposeError;
pub use modules::{module_names, module_source};
pub use permutation::Permutation;
pub use source::shader_source;
pub use texture_bytes::{MipBytes, TextureBytes, TextureFormat};
pub use uniforms::MarchUniforms;
