//! Getting the bytes of a file, and only of a file.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

use super::error::MapError;
use super::limits::Limits;

/// The path as it appears in messages.
pub(crate) fn name_of(path: &Path) -> String {
    path.display().to_string()
}

/// All bytes of a regular file.
pub(crate) fn read_bytes(path: &Path, limits: &Limits) -> Result<Vec<u8>, MapError> {
    let name = name_of(path);
    let failed = |source: io::Error| match source.kind() {
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => MapError::Missing { name: name.clone() },
        _ => MapError::Io { name: name.clone(), doing: "read the file", source },
    };
    // Before opening it: opening a pipe waits for someone to write.
    let metadata = fs::metadata(path).map_err(failed)?;
    if !metadata.is_file() {
        let what = if metadata.is_dir() { "a folder" } else { "a device, pipe or socket" };
        return Err(MapError::NotAFile { name, what });
    }
    let max_bytes = limits.max_bytes;
    if metadata.len() > max_bytes {
        return Err(MapError::FileSize { name, bytes: metadata.len(), max_bytes });
    }
    let mut bytes = Vec::new();
    // Some files (in /proc) are longer than they say.
    File::open(path).and_then(|file| file.take(max_bytes.saturating_add(1)).read_to_end(&mut bytes)).map_err(failed)?;
    if bytes.len() as u64 > max_bytes {
        return Err(MapError::FileSize { name, bytes: bytes.len() as u64, max_bytes });
    }
    Ok(bytes)
}
