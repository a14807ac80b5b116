//! The files of a folder, sorted into maps and others by their names.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::file_name::{ParsedName, parse_file_name};
use super::map_role::MapRole;
use crate::io::{IMAGE_EXTENSIONS, MapError, name_of};

/// A file whose name says that it is a map.
pub(super) struct Candidate {
    pub(super) path: PathBuf,
    /// The file's name, for notes.
    pub(super) file: String,
    /// Lower case.
    pub(super) extension: String,
    pub(super) name: ParsedName,
}

impl Candidate {
    /// True if the file holds a map that a material uses.
    pub(super) fn is_used(&self) -> bool {
        !matches!(self.name.role, MapRole::Unused(_))
    }
}

/// The files of a folder, sorted by name.
#[derive(Default)]
pub(super) struct FolderListing {
    pub(super) candidates: Vec<Candidate>,
    /// Images whose names say nothing.
    pub(super) unknown: Vec<String>,
    /// Everything else.
    pub(super) not_images: Vec<String>,
    /// A folder that usually holds the maps.
    pub(super) textures: Option<PathBuf>,
}

impl FolderListing {
    /// True if a file of the folder is a map that a material uses.
    pub(super) fn has_maps(&self) -> bool {
        self.candidates.iter().any(Candidate::is_used)
    }
}

/// Lists a folder without opening its files.
pub(super) fn list(dir: &Path) -> Result<FolderListing, MapError> {
    let name = || name_of(dir);
    let failed = |source: io::Error| match source.kind() {
        io::ErrorKind::NotFound => MapError::Missing { name: name() },
        _ => MapError::Io { name: name(), doing: "list the folder", source },
    };
    if !fs::metadata(dir).map_err(failed)?.is_dir() {
        return Err(MapError::NotAFolder { name: name() });
    }
    let mut entries = fs::read_dir(dir).and_then(Iterator::collect::<io::Result<Vec<_>>>).map_err(failed)?;
    entries.sort_by_key(fs::DirEntry::file_name);
    let mut listing = FolderListing::default();
    for entry in entries {
        let path = entry.path();
        let file = entry.file_name().to_string_lossy().into_owned();
        // Files that file managers leave behind.
        if file.starts_with('.') || ["thumbs.db", "desktop.ini"].contains(&file.to_ascii_lowercase().as_str()) {
            continue;
        }
        // Links are followed; a broken one is neither.
        let metadata = fs::metadata(&path);
        if metadata.as_ref().is_ok_and(fs::Metadata::is_dir) {
            if ["textures", "maps"].contains(&file.to_ascii_lowercase().as_str()) {
                listing.textures = listing.textures.or(Some(path));
            }
            continue;
        }
        let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
        if !metadata.is_ok_and(|m| m.is_file()) || !IMAGE_EXTENSIONS.contains(&extension.as_str()) {
            listing.not_images.push(file);
            continue;
        }
        let stem = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
        match parse_file_name(&stem) {
            Some(name) => listing.candidates.push(Candidate { path, file, extension, name }),
            None => listing.unknown.push(file),
        }
    }
    Ok(listing)
}
