use std::path::Path;

use anyhow::{Result, bail};
use relievo_map::{Grid, dequantise8, write_png8};

/// Writes display RGB as an 8-bit PNG, whole or not at all.
pub(crate) fn write_picture(path: &Path, pixels: &Grid<[u8; 3]>) -> Result<()> {
    write_png8(path, &pixels.map(|rgb| rgb.map(dequantise8)))?;
    Ok(())
}

/// Refuses, before any work is done, a picture that could not be written in the end.
pub(crate) fn check_picture_path(path: &Path) -> Result<()> {
    match extension(path).as_str() {
        "png" => check_folder(path),
        _ => bail!("{}: pictures are written as PNG; name a file that ends in .png", path.display()),
    }
}

/// Refuses a file whose folder is not there, or that is a folder itself.
pub(crate) fn check_folder(path: &Path) -> Result<()> {
    if path.is_dir() {
        bail!("{} is a folder; name a file in it", path.display());
    }
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => {
            bail!("{}: the folder {} does not exist; make it first", path.display(), folder.display())
        }
        _ => Ok(()),
    }
}

/// The file name's ending, in lower case.
pub(crate) fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_lowercase()
}
