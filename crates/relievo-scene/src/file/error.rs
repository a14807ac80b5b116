use std::fmt;
use std::io;
use std::path::PathBuf;

use thiserror::Error;

use crate::ModelError;

/// Location in the description of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SourceLocation {
    /// A line of the scene file, from 1.
    Line {
        /// The scene's name: its path as given.
        file: String,
        /// Line number, from 1.
        line: usize,
    },
    /// The scene file as a whole.
    File(String),
    /// An [`Override`](crate::Override), as `path=value`.
    Set(String),
}

impl fmt::Display for SourceLocation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line { file, line } => write!(f, "{file}:{line}"),
            Self::File(file) => f.write_str(file),
            Self::Set(text) => write!(f, "--set {text}"),
        }
    }
}

/// Reason why a scene could not be loaded. The text names the line, the key, what was expected and what to do.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The scene file itself could not be read.
    #[error("{}: cannot read the scene file: {source}", path.display())]
    Read {
        /// The scene file.
        path: PathBuf,
        /// The cause.
        source: io::Error,
    },
    /// Something in the scene file or an override is wrong.
    #[error("{location}: {message}")]
    Invalid {
        /// Location of the mistake.
        location: SourceLocation,
        /// The mistake, what was expected, and the nearest known name.
        message: String,
    },
    /// A map could not be read or made.
    #[error("{location}: {what}: {source}")]
    Map {
        /// Location of the name of the map.
        location: SourceLocation,
        /// The key and its table.
        what: String,
        /// A `relievo_map::MapError` or `relievo_make::MakeError`.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// A mesh file could not be read.
    #[error("{location}: mesh: {source}")]
    Model {
        /// Location of the name of the file.
        location: SourceLocation,
        /// The cause.
        source: ModelError,
    },
}

impl SceneError {
    /// Returns the location of the mistake; `None` if the scene file could not be read at all.
    #[must_use]
    pub fn location(&self) -> Option<&SourceLocation> {
        match self {
            Self::Read { .. } => None,
            Self::Invalid { location, .. } | Self::Map { location, .. } | Self::Model { location, .. } => {
                Some(location)
            }
        }
    }
}
