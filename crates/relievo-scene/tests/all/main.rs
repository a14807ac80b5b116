//! The crate from outside: scene files, meshes, mesh files, and what happens when they are broken.

mod animation;
mod glb;
mod gltf_files;
mod meshes;
mod mist;
mod moved_uvs;
mod mutations;
mod obj_files;
mod overrides;
mod scene_files;
mod two_sides;
