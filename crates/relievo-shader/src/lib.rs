//! Relief mapping in WGSL, for any engine: the marches and shadows as modules, composed to one text; their settings as a uniform
//! buffer; and height maps laid out as the bytes of textures. Knows no graphics API.
//!
//! ```text
//!  wgsl/*.wgsl ──Composer── Permutation ──▶ one WGSL text: relievo_march, relievo_shadow ──▶ your pipeline
//!  ReliefMap ──TextureBytes──▶ relievo_heights, relievo_pyramid, relievo_cones           ──▶ your textures
//!  MarchOptions ──MarchUniforms──▶ RelievoMarchOptions                                    ──▶ your uniform buffer
//! ```
//!
//! # Features
//! - All techniques and self-shadows of `relievo-march`, step by step: the same ray gives the same record, up to the last bits of
//!   the device's arithmetic. Every loop is bounded, heights are read by `textureLoad`, and nothing takes derivatives, so the
//!   march may stand in any control flow.
//! - All names begin with `relievo_`, `Relievo` or `RELIEVO_`; [`shader_source_named`] gives a second relief other names.
//! - [`naga_oil_modules`]: the same modules for naga_oil.
//! - Feature `translate`: GLSL ES 3.00, GLSL, HLSL, MSL and SPIR-V, by naga.
//!
//! # State and limits
//! The interface may still change. The modules of relievo-gpu's renderer are here as well, for reading and replacing; their
//! bindings are that renderer's.
//!
//! ```
//! use relievo_march::{Shadow, Technique};
//! use relievo_shader::{Permutation, shader_source};
//!
//! let permutation = Permutation { technique: Technique::Relief, shadow: Shadow::Soft, ..Permutation::default() };
//! let wgsl = [
//!     permutation.texture_declarations(0, 0),
//!     shader_source(&permutation)?,
//!     "// Your entry points, with: relievo_march(relievo_height_field(0.0, 0), ray, relievo_default_options())".to_owned(),
//! ]
//! .concat();
//! # assert!(wgsl.contains("fn relievo_march_relief("));
//! # Ok::<(), relievo_shader::ComposeError>(())
//! ```

mod composer;
mod error;
mod modules;
mod naga_oil;
mod permutation;
mod prefix;
mod source;
mod texture_bytes;
mod textures;
#[cfg(feature = "translate")]
pub mod translate;
mod uniforms;

pub use composer::Composer;
pub use error::ComposeError;
pub use modules::{module_names, module_source};
pub use naga_oil::{NagaOilModule, naga_oil_modules};
pub use permutation::Permutation;
pub use prefix::with_prefix;
pub use source::{shader_source, shader_source_named};
pub use texture_bytes::{MipBytes, TextureBytes, TextureFormat};
pub use textures::{TextureGlobal, TextureSample, TextureSource};
pub use uniforms::MarchUniforms;
