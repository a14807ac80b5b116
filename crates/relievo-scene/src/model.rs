//! Mesh files: glTF and OBJ.

mod gltf;
mod obj;
mod part;
mod read_file;

use std::path::Path;

use relievo_map::Limits;

pub use part::{Model, ModelError, Part};

/// The formats of mesh files, by the ending of the name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FileKind {
    Gltf,
    Obj,
}

impl FileKind {
    pub(crate) fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "glb" | "gltf" => Some(Self::Gltf),
            "obj" => Some(Self::Obj),
            _ => None,
        }
    }
}

impl Model {
    /// Reads a `.glb`, `.gltf` or `.obj` file.
    ///
    /// Missing normals and MikkTSpace tangents are generated; triangles without area are dropped. `with_materials` also
    /// reads the file's own materials and their images, each at most as large as `limits` say.
    ///
    /// # Errors
    /// If the file cannot be read, is broken, too large, or holds no triangles.
    pub fn load(path: &Path, limits: &Limits, with_materials: bool) -> Result<Self, ModelError> {
        let model = match FileKind::of(path) {
            Some(FileKind::Gltf) => gltf::load(path, limits, with_materials),
            Some(FileKind::Obj) => obj::load(path),
            None => return Err(ModelError::new(path, "expected a file that ends in .glb, .gltf or .obj")),
        }?;
        if model.parts.is_empty() {
            return Err(ModelError::new(path, "there are no triangles in it"));
        }
        Ok(model)
    }
}
