use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use crate::io_error::plainly;

/// Reads a regular text file of at most `max` bytes; `what` it is, as in "a scene file".
pub(super) fn read_limited(path: &Path, max: u64, what: &str) -> io::Result<Vec<u8>> {
    let metadata = path.metadata().map_err(plainly)?;
    if metadata.is_dir() {
        return Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a folder; name a file (TOML) in it"));
    }
    if !metadata.is_file() {
        return Err(io::Error::other("it is not a regular file"));
    }
    let mut bytes = Vec::new();
    File::open(path)?.take(max + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > max {
        return Err(io::Error::other(format!("it is far too long for {what}")));
    }
    Ok(bytes)
}
