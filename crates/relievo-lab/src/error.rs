use std::path::PathBuf;

use relievo_cpu::RenderError;
use relievo_journal::JournalError;
use relievo_map::MapError;
use relievo_scene::SceneError;
use thiserror::Error;

use crate::compare::CompareError;
use crate::metric::FlipError;

/// An error of a sweep, of tuning or of a report.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LabError {
    /// The options are out of range, or leave nothing to do.
    #[error("{0}")]
    Options(String),
    /// The folder for the results cannot be used.
    #[error("{}: {doing} failed: {source}", path.display())]
    Folder {
        /// Path of the folder or file.
        path: PathBuf,
        /// The operation that failed.
        doing: &'static str,
        /// The system's error.
        source: std::io::Error,
    },
    /// The folder's journal of finished cases cannot be read or written.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// A file cannot be written, or a picture not be read back.
    #[error(transparent)]
    Map(#[from] MapError),
    /// A picture cannot be drawn.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A picture cannot be drawn.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// Pictures cannot be compared.
    #[error(transparent)]
    Compare(#[from] CompareError),
    /// Pictures cannot be judged.
    #[error(transparent)]
    Flip(#[from] FlipError),
    /// The GPU failed.
    #[cfg(feature = "gpu")]
    #[error(transparent)]
    Gpu(#[from] relievo_gpu::GpuError),
}
