use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::builder::{PathBufValueParser, TypedValueParser};
use relievo_map::write_atomic;
use serde::Serialize;

use crate::console::{WrongUsage, print};

/// The name that stands for stdout.
const STDOUT: &str = "-";

/// A picture's path, refused where its name promises another format.
pub(crate) fn picture_parser() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(|path| match extension(&path).as_str() {
        "png" => Ok(path),
        _ => Err("pictures are written as PNG; name a file that ends in .png"),
    })
}

/// The path of a picture or a film.
pub(crate) fn film_parser() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(|path| match extension(&path).as_str() {
        "png" | "apng" | "webp" => Ok(path),
        _ => Err("pictures are written as PNG; name a file that ends in .png, or for a film in .apng or .webp"),
    })
}

/// Refuses, before any work is done, files that could not be written in the end, that would overwrite each other, or
/// that would overwrite the scene.
pub(crate) fn check_outputs(outputs: &[&Path], scene: Option<&Path>) -> Result<()> {
    let mut taken: Vec<PathBuf> = Vec::new();
    for path in outputs.iter().filter(|path| path.as_os_str() != STDOUT) {
        check_writable(path)?;
        let Some(file) = replaced_file(path) else { continue };
        if scene.and_then(replaced_file).as_ref() == Some(&file) {
            bail!(WrongUsage(format!("{}: this would overwrite the scene file; choose another name", path.display())));
        }
        if taken.contains(&file) {
            bail!(WrongUsage(format!("{}: two outputs go to this file; give each its own", path.display())));
        }
        taken.push(file);
    }
    if outputs.iter().filter(|path| path.as_os_str() == STDOUT).count() > 1 {
        bail!(WrongUsage("two outputs go to stdout; give one of them a file".to_owned()));
    }
    Ok(())
}

/// A folder to write into: there already, or made in one that is.
pub(crate) fn make_folder(folder: &Path) -> Result<()> {
    check_folder(folder)?;
    if !folder.is_dir() {
        fs::create_dir(folder).with_context(|| format!("{}: the folder cannot be made", folder.display()))?;
    }
    Ok(())
}

/// Refuses, before any work is done, a folder that could not be written into.
pub(crate) fn check_folder(folder: &Path) -> Result<()> {
    if let Ok(found) = fs::metadata(folder) {
        if !found.is_dir() {
            bail!("{}: this is a file, but a folder is needed for the maps; choose another name", folder.display());
        }
        if found.permissions().readonly() {
            bail!("{}: this folder is read-only; choose another, or make it writable", folder.display());
        }
        return Ok(());
    }
    match folder.parent() {
        Some(parent) if !parent.as_os_str().is_empty() && !parent.is_dir() => {
            bail!("{}: there is no folder {}; make it first", folder.display(), parent.display())
        }
        _ => Ok(()),
    }
}

fn check_writable(path: &Path) -> Result<()> {
    let existing = fs::metadata(path);
    if path.is_dir() {
        bail!("{}: this is a folder; name a file in it", path.display());
    }
    if existing.is_ok_and(|file| file.is_file() && file.permissions().readonly()) {
        bail!("{}: this file is read-only; choose another name, or make it writable", path.display());
    }
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => {
            bail!("{}: there is no folder {}; make it first", path.display(), folder.display())
        }
        Some(folder) if fs::metadata(folder).is_ok_and(|folder| folder.permissions().readonly()) => {
            bail!("{}: the folder {} is read-only; choose another", path.display(), folder.display())
        }
        _ => Ok(()),
    }
}

/// The file that writing to `path` replaces, however it is spelt; `None` for devices and pipes, which hold nothing.
fn replaced_file(path: &Path) -> Option<PathBuf> {
    if let Ok(file) = fs::canonicalize(path) {
        return file.is_file().then_some(file);
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    Some(fs::canonicalize(folder).ok()?.join(path.file_name()?))
}

/// The file name's ending, in lower case.
pub(crate) fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_lowercase()
}

/// Writes figures as JSON, whole or not at all; `-` is stdout.
pub(crate) fn write_json(path: &Path, figures: &impl Serialize) -> Result<()> {
    let json = serde_json::to_string_pretty(figures)?;
    if path.as_os_str() == STDOUT {
        return print(format!("{json}\n").as_bytes());
    }
    write_atomic(path, |file| writeln!(file, "{json}"))?;
    Ok(())
}
