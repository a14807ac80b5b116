use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::Affine3A;
use thiserror::Error;

use crate::{Material, Mesh};

/// The content of a mesh file: its parts, each with a transform.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// The parts; those that are drawn several times share their mesh.
    pub parts: Vec<Part>,
    /// The file's own materials (glTF), for the technique `normal`.
    pub materials: Vec<Material>,
    /// Notes on what was left out or repaired.
    pub notes: Vec<String>,
}

/// A mesh of a file with its transform.
#[derive(Clone, Debug)]
pub struct Part {
    /// The geometry, in the part's own units.
    pub mesh: Arc<Mesh>,
    /// Index into [`Model::materials`], if the file gives it one and materials were asked for.
    pub material: Option<usize>,
    /// True if the file brings texture coordinates; else they are all 0.
    pub has_uvs: bool,
    /// True if the file says that it is visible from both sides.
    pub two_sided: bool,
    /// Transform from part to model space.
    pub transform: Affine3A,
}

/// Reason why a mesh file could not be read.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{}: {message}", path.display())]
pub struct ModelError {
    /// The file.
    pub path: PathBuf,
    /// The mistake and its remedy.
    pub message: String,
}

impl ModelError {
    pub(crate) fn new(path: &Path, message: impl Into<String>) -> Self {
        Self { path: path.to_owned(), message: message.into() }
    }
}
