//! The names of a scene file and of what was changed in it, for errors.

use relievo_toml::{At, Entry};

use crate::error::{Place, SceneError};

/// The names that turn an [`At`] into a [`Place`].
#[derive(Clone, Debug, Default)]
pub(crate) struct Source {
    /// The scene's name.
    pub(crate) name: String,
    /// The overrides as `path=value`.
    pub(crate) overrides: Vec<String>,
}

impl Source {
    pub(crate) fn place(&self, at: At) -> Place {
        match at {
            At::Line(line) => Place::Line { file: self.name.clone(), line },
            At::Set(number) => Place::Set(self.overrides.get(number).cloned().unwrap_or_default()),
            At::Whole => Place::File(self.name.clone()),
        }
    }

    pub(crate) fn error(&self, at: At, message: impl Into<String>) -> SceneError {
        SceneError::Invalid { place: self.place(at), message: message.into() }
    }
}

/// Parses a scene file.
pub(crate) fn parse(text: &str, source: &Source) -> Result<Vec<Entry>, SceneError> {
    relievo_toml::parse(text).map_err(|error| source.error(error.location, error.message))
}
