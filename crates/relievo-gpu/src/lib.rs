//! Relief mapping for wgpu, for two readers: who takes the shader functions, and who takes the renderer.
//!
//! ```text
//!  shaders/*.wgsl ──Composer── Permutation ──▶ one WGSL text: relief_march, relief_shadow ──▶ your pipeline
//!                                                │
//!  ReliefMap ──▶ HeightTexture ──▶ ComputeMarch ───┤ rays in, records out
//!                                                │
//!  Scene ──Renderer::new──▶ maps, meshes ──draw──┘──▶ a texture view of yours, or of an Offscreen
//! ```
//!
//! The functions are those of `relievo-march`, step by step: the same ray gives the same record, up to the last bits of
//! the device's arithmetic. Every loop is bounded, heights are read by `textureLoad`, and nothing takes derivatives, so the
//! march may stand in any control flow.
//!
//! ```
//! use relievo_gpu::{Permutation, shader_source};
//! use relievo_march::{Shadow, Technique};
//!
//! let choices = Permutation { technique: Technique::Relief, shadow: Shadow::Soft, ..Permutation::default() };
//! let wgsl = format!(
//!     "@group(0) @binding(0) var relief_heights: texture_2d<f32>;\n{}\n{}",
//!     shader_source(&choices)?,
//!     "// Your entry points: let record = relief_march(height_field(0.0, 0), ray, options);"
//! );
//! # assert!(wgsl.contains("fn march_relief("));
//! # Ok::<(), relievo_gpu::ComposeError>(())
//! ```

mod compute;
mod cone_texture;
mod device;
mod error;
mod geometry;
mod height_mips;
mod height_texture;
mod layout;
mod live_heights;
mod map_texture;
mod material;
mod measure;
mod offscreen;
mod pipelines;
mod pyramid_kernels;
mod pyramid_plan;
mod readback;
mod render_permutation;
mod renderer;
mod shadow_maps;
mod shadow_views;
mod supersample;
mod surroundings;
mod tier;
mod view;

pub use compute::{ComputeField, ComputeMarch};
pub use device::{AdapterChoice, Gpu, adapter_name, adapters, interface_name, is_real};
pub use error::GpuError;
pub use height_texture::HeightTexture;
pub use live_heights::{Coding, LiveHeights};
pub use offscreen::{FrameTime, Offscreen};
pub use relievo_shader::{ComposeError, Composer, Permutation, module_names, module_source, shader_source};
pub use renderer::{Renderer, RendererOptions, Target, Timestamps};
pub use tier::Tier;
