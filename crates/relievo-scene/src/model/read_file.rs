use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::part::ModelError;
use crate::io_error::plainly;

/// Largest mesh file, and largest buffer file of a glTF, bytes.
const MAX_BYTES: u64 = 4 << 30;

/// Reads a whole regular file.
pub(super) fn read_file(path: &Path) -> Result<Vec<u8>, ModelError> {
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
