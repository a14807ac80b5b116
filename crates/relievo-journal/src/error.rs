use std::path::PathBuf;

use relievo_map::MapError;
use thiserror::Error;

/// Reasons for which a journal cannot be read or kept.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum JournalError {
    /// The journal's file is there, but cannot be read.
    #[error("{}: the manifest cannot be read: {source}", path.display())]
    Unreadable {
        /// The journal's file.
        path: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
    /// The file is not a journal.
    #[error("{}: this is no manifest of Relievo ({reason}); move it away", path.display())]
    NotAJournal {
        /// The file.
        path: PathBuf,
        /// The part of it that was not understood.
        reason: String,
    },
    /// The file was written by a later version of Relievo.
    #[error(
        "{}: this manifest was written by a later version of Relievo (its format is {version}, this version knows up to {}); \
         use that version, choose another folder, or move the file away to do everything again",
        path.display(),
        known
    )]
    NewerFormat {
        /// The journal's file.
        path: PathBuf,
        /// The format's version.
        version: u64,
        /// The latest version that is read.
        known: u32,
    },
    /// A file that work reads has no size or time of change.
    #[error("{}: cannot be read: {source}", path.display())]
    Input {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
    /// Options cannot be serialised as JSON.
    #[error("these options cannot be written down: {0}")]
    Options(#[from] serde_json::Error),
    /// The journal's file cannot be written.
    #[error(transparent)]
    Write(#[from] MapError),
}
