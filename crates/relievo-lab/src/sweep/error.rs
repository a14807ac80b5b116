use std::path::PathBuf;

use relievo_cpu::RenderError;
use relievo_journal::JournalError;
use relievo_map::MapError;
use relievo_scene::SceneError;
use thiserror::Error;

use crate::{CompareError, FlipError};

/// Why nothing could be measured, or no report written.
#[derive(Debug, Error)]
pub enum LabError {
    /// The options leave nothing to do, or ask for what cannot be.
    #[error("{0}")]
    Options(String),
    /// The folder for the results cannot be used.
    #[error("{}: {doing} failed: {source}", path.display())]
    Folder {
        /// Which.
        path: PathBuf,
        /// What was tried.
        doing: &'static str,
        /// The system's words.
        source: std::io::Error,
    },
    /// The folder's journal of finished cases cannot be read or kept.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// The exact walk over every cell cannot be had on a GPU.
    #[error("the GPU's march cannot be made to go cell by cell; leave exact:cells out")]
    CellsOnGpu,
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
