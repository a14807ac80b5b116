//! The names of a scene file and of what was changed in it, for errors.

use relievo_toml::{Entry, Location};

use super::error::{SceneError, SourceLocation};

/// Names that turn a [`Location`] into a [`SourceLocation`].
#[derive(Clone, Debug, Default)]
pub(super) struct Source {
    /// Name of the scene.
    pub(super) name: String,
    /// Overrides as `path=value`.
    pub(super) overrides: Vec<String>,
}

impl Source {
    pub(super) fn location(&self, at: Location) -> SourceLocation {
        match at {
            Location::Line(line) => SourceLocation::Line { file: self.name.clone(), line },
            Location::Set(number) => SourceLocation::Set(self.overrides.get(number).cloned().unwrap_or_default()),
            Location::Whole => SourceLocation::File(self.name.clone()),
        }
    }

    pub(super) fn error(&self, at: Location, message: impl Into<String>) -> SceneError {
        SceneError::Invalid { location: self.location(at), message: message.into() }
    }
}

/// Parses a scene file.
pub(super) fn parse(text: &str, source: &Source) -> Result<Vec<Entry>, SceneError> {
    relievo_toml::parse(text).map_err(|error| source.error(error.location, error.message))
}
