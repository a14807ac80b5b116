//! Mesh files: what is common to all formats.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::Affine3A;
use relievo_map::Limits;
use thiserror::Error;

use crate::error::plainly;
use crate::{Material, Mesh, gltf_file, obj_file};

/// A mesh file: its parts, each with a place.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// What is to be drawn; parts that are drawn several times share their mesh.
    pub parts: Vec<Part>,
    /// The file's own materials (glTF), for the technique `normal`.
    pub materials: Vec<Material>,
    /// What was left out or repaired.
    pub notes: Vec<String>,
}

/// A mesh of a file, at its place.
#[derive(Clone, Debug)]
pub struct Part {
    /// The geometry, in the part's own units.
    pub mesh: Arc<Mesh>,
    /// Index into [`Model::materials`], if the file gives it one and materials were asked for.
    pub material: Option<usize>,
    /// Whether the file brings texture coordinates; else they are all 0.
    pub has_uvs: bool,
    /// Part to model.
    pub transform: Affine3A,
}

/// Why a mesh file could not be read.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{}: {message}", path.display())]
pub struct ModelError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it and what to do.
    pub message: String,
}

impl ModelError {
    pub(crate) fn new(path: &Path, message: impl Into<String>) -> Self {
        Self { path: path.to_owned(), message: message.into() }
    }
}

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
            Some(FileKind::Gltf) => gltf_file::load(path, limits, with_materials),
            Some(FileKind::Obj) => obj_file::load(path),
            None => return Err(ModelError::new(path, "expected a file that ends in .glb, .gltf or .obj")),
        }?;
        if model.parts.is_empty() {
            return Err(ModelError::new(path, "there are no triangles in it"));
        }
        Ok(model)
    }
}

/// The largest mesh file, and the largest buffer file of a glTF.
const MAX_BYTES: u64 = 4 << 30;

/// Reads a whole regular file.
pub(crate) fn read_file(path: &Path) -> Result<Vec<u8>, ModelError> {
    let failed = |error: std::io::Error| ModelError::new(path, format!("cannot read it: {}", plainly(error)));
    let metadata = path.metadata().map_err(failed)?;
    if !metadata.is_file() {
        let what = if metadata.is_dir() { "a folder" } else { "not a regular file" };
        return Err(ModelError::new(path, format!("this is {what}; name a mesh file")));
    }
    let mut bytes = Vec::new();
    File::open(path).and_then(|file| file.take(MAX_BYTES + 1).read_to_end(&mut bytes)).map_err(failed)?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(ModelError::new(path, format!("it is larger than {} GiB", MAX_BYTES >> 30)));
    }
    Ok(bytes)
}
