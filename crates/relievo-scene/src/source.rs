//! The names of a scene file and of what was changed in it, for errors.

use relievo_toml::{At, Entry};

use crate::error::{SourceLocation, SceneError};

/// The names that turn an [`At`] into a [`SourceLocation`].
#[derive(Clone, Debug, Default)]
pub(crate) struct Source {
    /// The scene's name.
    pub(crate) name: String,
    /// The overrides as `path=value`.
    pub(crate) overrides: Vec<String>,
}

impl Source {
    pub(crate) fn location(&self, at: At) -> SourceLocation {
        match at {
            At::Line(line) => SourceLocation::Line { file: self.name.clone(), line },
            At::Set(number) => SourceLocation::Set(self.overrides.get(number).cloned().unwrap_or_default()),
            At::Whole => SourceLocation::File(self.name.clone()),
        }
    }

    pub(crate) fn error(&self, at: At, message: impl Into<String>) -> SceneError {
        SceneError::Invalid { location: self.location(at), message: message.into() }
    }
}

/// Parses a scene file.
pub(crate) fn parse(text: &str, source: &Source) -> Result<Vec<Entry>, SceneError> {
    relievo_toml::parse(text).map_err(|(at, message)| source.error(at, message))
}
