//! The crate from outside: scene files, meshes, mesh files, and what happens when they are broken.

mod glb;

mod meshes;

mod scene_files;
