//! One map to make, and the place where it goes.

use std::fs;
use std::path::{Path, PathBuf};

use relievo_map::FolderMaps;

/// One map to read, and the place of the maps that are made of it.
pub(crate) struct MapJob {
    pub(crate) input: PathBuf,
    /// The material's maps, if the input was found in a folder by its name.
    pub(crate) found: Option<FolderMaps>,
    pub(crate) output: JobOutput,
}

/// The place of the maps that are made.
pub(crate) enum JobOutput {
    File(PathBuf),
    /// Files whose names begin with the material's: of a material in a folder, or of a loose file.
    Folder {
        folder: PathBuf,
        name: String,
    },
}

/// True if two paths lead to one file or folder.
pub(crate) fn is_same(a: &Path, b: &Path) -> bool {
    fs::canonicalize(a).is_ok_and(|a| fs::canonicalize(b).is_ok_and(|b| a == b))
}
