//! Files that appear whole or not at all.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

use super::error::MapError;

/// Writes a file so that it appears whole or not at all: into a temporary file beside it, which is then renamed.
///
/// If anything fails, an existing file at `path` stays as it was and the temporary file is removed. A symbolic link
/// is followed, so that the file it points to is replaced and the link stays. A device or a pipe (`/dev/null`) cannot
/// be replaced and is written to directly.
///
/// # Errors
/// If the folder is missing, the path is a folder, the existing file is read-only, `write` returns an error, or the
/// disk says no.
pub fn write_atomic(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), MapError> {
    let failed = |source| MapError::Io { name: path.display().to_string(), doing: "write the file", source };
    let existing = match fs::metadata(path) {
        Ok(metadata) => Some(metadata),
        Err(error) if error.kind() == io::ErrorKind::NotFound => None,
        Err(error) => return Err(failed(error)),
    };
    if let Some(existing) = &existing {
        if existing.is_dir() {
            return Err(failed(io::Error::new(
                io::ErrorKind::IsADirectory,
                "there is a folder of this name; give a file name inside it",
            )));
        }
        if !existing.is_file() {
            let mut out = BufWriter::new(OpenOptions::new().write(true).open(path).map_err(failed)?);
            return write(&mut out).and_then(|()| out.flush()).map_err(failed);
        }
        if existing.permissions().readonly() {
            return Err(failed(io::Error::new(
                io::ErrorKind::PermissionDenied,
                "there is a file of this name and it is read-only",
            )));
        }
    }
    let target = if existing.is_some() { fs::canonicalize(path).map_err(failed)? } else { path.to_owned() };
    let (mut temporary, file) = Temporary::beside(&target).map_err(failed)?;
    let mut out = BufWriter::new(file);
    write(&mut out).map_err(failed)?;
    let file = out.into_inner().map_err(|error| failed(error.into_error()))?;
    if let Some(existing) = existing {
        file.set_permissions(existing.permissions()).map_err(failed)?;
    }
    // Without this a power cut after the rename could leave an empty file under the final name.
    file.sync_all().map_err(failed)?;
    drop(file);
    temporary.become_file(&target).map_err(failed)
}

/// A file that is removed when dropped, unless it was renamed.
struct Temporary {
    path: Option<PathBuf>,
}

impl Temporary {
    /// A new file in the same folder as `target`, so that a rename never crosses file systems.
    fn beside(target: &Path) -> io::Result<(Self, File)> {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let Some(name) = target.file_name() else {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "this path does not end in a file name"));
        };
        let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        if !folder.is_dir() {
            return Err(io::Error::new(
                io::ErrorKind::NotFound,
                format!("there is no folder {}; make it first", folder.display()),
            ));
        }
        loop {
            // Long names leave no room for a suffix: keep the beginning only.
            let start: String = name.to_string_lossy().chars().take(40).collect();
            let count = COUNT.fetch_add(1, Ordering::Relaxed);
            let path = folder.join(format!(".{start}.{}-{count}.part", std::process::id()));
            match OpenOptions::new().write(true).create_new(true).open(&path) {
                Ok(file) => return Ok((Self { path: Some(path) }, file)),
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
    }

    /// Renames it to its final name.
    fn become_file(&mut self, target: &Path) -> io::Result<()> {
        if let Some(path) = &self.path {
            fs::rename(path, target)?;
        }
        self.path = None;
        Ok(())
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if let Some(path) = &self.path {
            // Already failing: the first error is the one to tell.
            let _ = fs::remove_file(path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_finished_file_replaces_the_old_one_and_leaves_nothing_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.txt");
        write_atomic(&path, |out| out.write_all(b"one")).unwrap();
        write_atomic(&path, |out| out.write_all(b"two")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two");
        assert_eq!(names(folder.path()), ["out.txt"]);
    }

    #[test]
    fn a_failure_half_way_leaves_the_old_file_and_nothing_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.txt");
        fs::write(&path, "old").unwrap();
        let error = write_atomic(&path, |out| {
            out.write_all(b"half of")?;
            Err(io::Error::other("the encoder stumbled"))
        })
        .unwrap_err();
        assert!(error.to_string().contains("out.txt") && error.to_string().contains("stumbled"), "{error}");
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["out.txt"]);
    }

    #[test]
    fn a_panic_half_way_leaves_nothing_beside_the_old_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.txt");
        fs::write(&path, "old").unwrap();
        let result = std::panic::catch_unwind(|| write_atomic(&path, |_| panic!("a bug in the caller")));
        assert!(result.is_err());
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["out.txt"]);
    }

    #[test]
    fn a_missing_folder_and_a_folder_as_output_are_explained() {
        let folder = tempfile::tempdir().unwrap();
        let error = write_atomic(&folder.path().join("no/such/a.png"), |_| Ok(())).unwrap_err().to_string();
        assert!(error.contains("a.png") && error.contains("make it first"), "{error}");
        let error = write_atomic(folder.path(), |_| Ok(())).unwrap_err().to_string();
        assert!(error.contains("folder of this name"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn links_stay_links_and_devices_stay_devices() {
        let folder = tempfile::tempdir().unwrap();
        let (real, link) = (folder.path().join("real.txt"), folder.path().join("link.txt"));
        fs::write(&real, "old").unwrap();
        std::os::unix::fs::symlink(&real, &link).unwrap();
        write_atomic(&link, |out| out.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&real).unwrap(), b"new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        write_atomic(Path::new("/dev/null"), |out| out.write_all(b"gone")).unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }

    #[test]
    fn a_read_only_file_is_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("kept.txt");
        fs::write(&path, "kept").unwrap();
        let mut permissions = fs::metadata(&path).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&path, permissions).unwrap();
        assert!(write_atomic(&path, |out| out.write_all(b"new")).unwrap_err().to_string().contains("read-only"));
        assert_eq!(fs::read(&path).unwrap(), b"kept");
    }
}
