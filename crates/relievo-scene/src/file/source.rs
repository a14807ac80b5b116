//! The names of a scene file and of what was changed in it, for errors.

use relievo_toml::{At, Entry};

use super::error::{SceneError, SourceLocation};

/// Names that turn an [`At`] into a [`SourceLocation`].
#[derive(Clone, Debug, Default)]
pub(super) struct Source {
    /// Name of the scene.
    pub(super) name: String,
    /// Overrides as `path=value`.
    pub(super) overrides: Vec<String>,
}

impl Source {
    pub(super) fn location(&self, at: At) -> SourceLocation {
        match at {
            At::Line(line) => SourceLocation::Line { file: self.name.clone(), line },
            At::Set(number) => SourceLocation::Set(self.overrides.get(number).cloned().unwrap_or_default()),
            At::Whole => SourceLocation::File(self.name.clone()),
        }
    }

    pub(super) fn error(&self, at: At, message: impl Into<String>) -> SceneError {
        SceneError::Invalid { location: self.location(at), message: message.into() }
    }
}

/// Parses a scene file.
pub(super) fn parse(text: &str, source: &Source) -> Result<Vec<Entry>, SceneError> {
    relievo_toml::parse(text).map_err(|error| source.error(error.location, error.message))
}
