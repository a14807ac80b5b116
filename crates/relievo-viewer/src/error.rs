use std::path::PathBuf;

use relievo_gpu::GpuError;
use relievo_map::MapError;
use thiserror::Error;

/// Reasons for which the window could not open, or had to close.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ViewerError {
    /// There is no display, or the libraries are missing that talk to it.
    #[error(
        "there is no display to open a window on ({0}): `relievo render` draws the same scene into a file without one"
    )]
    NoDisplay(String),
    /// The window system refused something.
    #[error("the window failed: {0}")]
    Window(String),
    /// The GPU cannot draw the scene.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The device was lost, and lost again once it was opened anew.
    #[error("the GPU was lost twice in a row ({0}): restart its driver, choose another with --adapter, or draw less")]
    Lost(String),
    /// A script cannot be read, or says what cannot be done.
    #[error("{}{}: {message}", file.display(), line.map_or_else(String::new, |line| format!(":{line}")))]
    Script {
        /// The script.
        file: PathBuf,
        /// Line number from 1; `None` for the file as a whole.
        line: Option<usize>,
        /// Text of the error.
        message: String,
    },
    /// A screenshot could not be written.
    #[error(transparent)]
    Screenshot(#[from] MapError),
}
