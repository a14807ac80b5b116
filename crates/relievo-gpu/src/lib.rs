//! Relief mapping for wgpu: height maps on a device, the marches as compute kernels, and a renderer that draws a Relievo scene.
//!
//! ```text
//!  ReliefMap ──▶ HeightTexture ──▶ ComputeMarch                    rays in, records out
//!                     └──────────▶ your pipeline                   relievo_march, relievo_shadow of relievo-shader
//!  Scene ──Renderer::new──▶ maps, meshes ──draw──▶ a texture view of yours, or of an Offscreen
//! ```
//!
//! # Features
//! - [`HeightTexture`] and [`LiveHeights`] (heights that change on the device), with bind group entries for shaders of one's own.
//! - [`ComputeMarch`]: the functions of `relievo-march`, step by step: the same ray gives the same record, up to the last bits of
//!   the device's arithmetic.
//! - Feature `renderer` (on by default): [`Renderer`] draws a scene of `relievo-scene` into a texture that the caller owns.
//!
//! # State and limits
//! Works with wgpu 30 and glam 0.34, whose types its interface has. For another wgpu take the shaders and the bytes of the
//! textures from `relievo-shader`. Everything but computing works on devices of WebGL2's class; see [`Tier`].
//!
//! ```
//! use relievo_gpu::{Permutation, shader_source, texture_layout_entries};
//! use relievo_march::{Shadow, Technique};
//!
//! let permutation = Permutation { technique: Technique::Relief, shadow: Shadow::Soft, ..Permutation::default() };
//! let wgsl = [
//!     permutation.texture_declarations(0, 0),
//!     shader_source(&permutation)?,
//!     "// Your entry points, with: relievo_march(relievo_height_field(0.0, 0), ray, relievo_default_options())".to_owned(),
//! ]
//! .concat();
//! let layout = texture_layout_entries(&permutation, 0, wgpu::ShaderStages::FRAGMENT);
//! # assert!(wgsl.contains("fn relievo_march_relief(") && layout.len() == 1);
//! # Ok::<(), relievo_gpu::ComposeError>(())
//! ```

mod compute;
mod device;
mod field;
#[cfg(feature = "renderer")]
mod renderer;

pub use compute::{ComputeField, ComputeMarch};
pub use device::{
    AdapterChoice, FrameTime, Gpu, GpuError, Offscreen, Tier, Timestamps, adapter_name, adapters, interface_name,
    is_real, read_rgb, read_texture,
};
pub use field::{HeightTexture, LiveHeights, Quantization, texture_layout_entries};
pub use relievo_shader::{
    ComposeError, Composer, MarchUniforms, Permutation, module_names, module_source, shader_source, shader_source_named,
};
#[cfg(feature = "renderer")]
pub use renderer::{Renderer, RendererOptions, Target};
