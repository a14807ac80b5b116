//! The renderer of scenes.

mod attachments;
mod bindings;
mod check;
mod draw;
mod environment;
mod formats;
mod frames;
mod geometry;
mod height_kernel;
mod layout;
mod live_material;
mod map_uploader;
mod material;
mod measure;
mod mist;
mod mist_layout;
mod mist_pass;
mod mist_targets;
mod options;
mod pass;
mod pass_descriptor;
mod permutation;
mod pipelines;
mod scene_renderer;
mod shadow_maps;
mod shadow_pass;
mod shadow_views;
mod shadows;
mod shells;
mod supersample;
mod view;

pub use options::{RendererOptions, Target};
pub use scene_renderer::Renderer;
