//! What is to be drawn: camera, lights, meshes, materials, and the scene file that names them.
//!
//! ```text
//!  scene.toml ──parse──▶ description ──load maps and meshes──▶ Scene ──▶ relievo-cpu, relievo-gpu
//! ```
//!
//! A [`Scene`] is complete: every map is in memory, every mesh has normals, texture coordinates and MikkTSpace tangents.
//! The conventions are glTF's: right-handed, +Y up, UV origin at the top left with v down.

mod camera;
mod error;
mod faces;
mod gltf_file;
mod keys;
mod light;
mod load;
mod maps;
mod material;
mod material_section;
mod mesh;
mod model;
mod obj_file;
mod object_section;
mod overrides;
mod reader;
mod scene;
mod sections;
mod shapes;
mod tangents;
mod tree;

pub use camera::Camera;
pub use error::{Place, SceneError};
pub use keys::{SCENE_KEYS, SceneKey, scene_keys_markdown};
pub use light::{Light, LightKind};
pub use load::LoadOptions;
pub use material::{Edge, Filter, HeightRange, Material, Relief, SurfaceTechnique};
pub use mesh::{Mesh, MeshError};
pub use model::{Model, ModelError, Part};
pub use overrides::{Override, OverrideError};
pub use scene::{ColorSpace, ImageSettings, Object, Scene, Shading, ShadingModel};
pub use shapes::SHAPE_NAMES;
