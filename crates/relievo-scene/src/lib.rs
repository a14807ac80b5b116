//! Scenes for relief mapping: camera, lights, meshes, materials, and the scene file that names them.
//!
//! ```text
//!  scene.toml ─▶ tree (every node knows its line) ─▶ sections, checked ─▶ maps and meshes, read ─▶ Scene ─▶ relievo-cpu,
//!               ▲ --set path=value                                       ▲ images, folders, make:, glTF, OBJ   relievo-gpu
//! ```
//!
//! A [`Scene`] is complete: every map is in memory, every mesh has normals, texture coordinates and MikkTSpace tangents.
//! The conventions are glTF's: right-handed, +Y up, UV origin at the top left with v down.
//!
//! ```
//! use std::path::Path;
//!
//! use relievo_scene::{LoadOptions, Scene};
//!
//! let text = r#"
//!     [materials.wall]
//!     from = "make:brick-wall"
//!     [[objects]]
//!     mesh = "quad"
//! "#;
//! let options = LoadOptions { make_size: 64, overrides: vec!["objects.0.mesh=cube".parse()?], ..LoadOptions::default() };
//! let scene = Scene::parse(text, "scene.toml", Path::new("."), &options)?;
//! assert_eq!(scene.objects[0].mesh.triangles.len(), 12);
//!
//! let error = Scene::parse("[camera]\nfov = 3", "scene.toml", Path::new("."), &options).unwrap_err();
//! assert!(error.to_string().starts_with("scene.toml:2: unknown key \"fov\" in [camera]"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
#![doc = include_str!("../SCENE.md")]

mod angle;
mod camera;
mod environment;
mod file;
mod frame;
mod io_error;
mod light;
mod material;
mod mesh;
mod mist_volume;
mod model;
mod sample;
mod scene;
mod shading;
mod time;
mod unseen;
mod validate;

pub use camera::{Camera, CameraKind, ParallelRange};
pub use environment::EnvironmentMap;
pub use file::{
    AnimatedScene, LoadOptions, Override, OverrideError, SCENE_KEYS, SceneError, SceneKey, SourceLocation,
    scene_keys_markdown,
};
pub use frame::{Aovs, Frame};
pub use light::{Light, LightKind};
pub use material::{
    ChangingHeights, Edge, Filter, HeightRange, Material, Mist, MistError, Offset, Relief, Side, SurfaceTechnique,
    UvTransform,
};
pub use mesh::{Chart, Face, MarchSpace, Mesh, MeshError, ReliefDepth, SHAPE_NAMES, SurfaceMesh, Vertex};
pub use mist_volume::{MistSpan, MistVolume, mist_order};
pub use model::{Model, ModelError, Part};
pub use sample::sample_offset;
pub use scene::{ImageSettings, Object, Scene};
pub use shading::{ColorSpace, Shading, ShadingModel};
pub use time::SceneTime;
pub use validate::InvalidScene;

/// Tests of the example in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExample;
