//! What is to be drawn: camera, lights, meshes, materials, and the scene file that names them.
//!
//! ```text
//!  scene.toml ──parse──▶ description ──load maps and meshes──▶ Scene ──▶ relievo-cpu, relievo-gpu
//! ```
//!
//! A [`Scene`] is complete: every map is in memory, every mesh has normals, texture coordinates and MikkTSpace tangents.
//! The conventions are glTF's: right-handed, +Y up, UV origin at the top left with v down.

mod camera;
mod light;
mod material;
mod mesh;
mod scene;

pub use camera::Camera;
pub use light::{Light, LightKind};
pub use material::{Edge, Filter, HeightRange, Material, Relief, SurfaceTechnique};
pub use mesh::Mesh;
pub use scene::{ColorSpace, ImageSettings, Object, Scene, Shading, ShadingModel};
