use std::fmt;
use std::io;
use std::path::PathBuf;

use thiserror::Error;

use crate::ModelError;

/// Where in the scene's description something stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SourceLocation {
    /// A line of the scene file, from 1.
    Line {
        /// The scene's name: its path as given.
        file: String,
        /// From 1.
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

/// Why a scene could not be loaded. The text names the line, the key, what was expected and what to do.
#[derive(Debug, Error)]
pub enum SceneError {
    /// The scene file itself could not be read.
    #[error("{}: cannot read the scene file: {source}", path.display())]
    Read {
        /// The scene file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// Something in the scene file or an override is wrong.
    #[error("{location}: {message}")]
    Invalid {
        /// Where.
        location: SourceLocation,
        /// What, what was expected, and the nearest name.
        message: String,
    },
    /// A map could not be read or made.
    #[error("{location}: {what}: {source}")]
    Map {
        /// Where the map is named.
        location: SourceLocation,
        /// The key and its table.
        what: String,
        /// A `relievo_map::MapError` or `relievo_make::MakeError`.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// A mesh file could not be read.
    #[error("{location}: mesh: {source}")]
    Model {
        /// Where the file is named.
        location: SourceLocation,
        /// Why.
        source: ModelError,
    },
}

impl SceneError {
    /// Where in the scene's description the mistake stands; `None` if the scene file could not be read at all.
    #[must_use]
    pub fn location(&self) -> Option<&SourceLocation> {
        match self {
            Self::Read { .. } => None,
            Self::Invalid { location, .. } | Self::Map { location, .. } | Self::Model { location, .. } => Some(location),
        }
    }
}

/// The system's words for a file that is not there, without their number and with what to do.
pub(crate) fn plainly(error: io::Error) -> io::Error {
    match error.kind() {
        io::ErrorKind::NotFound => {
            io::Error::new(io::ErrorKind::NotFound, "there is no such file; check the spelling and the folder")
        }
        _ => error,
    }
}

/// `a, b, c` for messages.
pub(crate) fn list<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    names.into_iter().collect::<Vec<_>>().join(", ")
}
