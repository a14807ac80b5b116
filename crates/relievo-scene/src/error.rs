use std::fmt;
use std::io;
use std::path::PathBuf;

use thiserror::Error;

use crate::ModelError;

/// Where in the scene's description something stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
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

impl fmt::Display for Place {
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
    #[error("{place}: {message}")]
    Invalid {
        /// Where.
        place: Place,
        /// What, what was expected, and the nearest name.
        message: String,
    },
    /// A map could not be read or made.
    #[error("{place}: {what}: {source}")]
    Map {
        /// Where the map is named.
        place: Place,
        /// The key and its table.
        what: String,
        /// A `relievo_map::MapError` or `relievo_make::MakeError`.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// A mesh file could not be read.
    #[error("{place}: mesh: {source}")]
    Model {
        /// Where the file is named.
        place: Place,
        /// Why.
        source: ModelError,
    },
}

impl SceneError {
    /// Where in the scene's description the mistake stands; `None` if the scene file could not be read at all.
    #[must_use]
    pub fn place(&self) -> Option<&Place> {
        match self {
            Self::Read { .. } => None,
            Self::Invalid { place, .. } | Self::Map { place, .. } | Self::Model { place, .. } => Some(place),
        }
    }
}

/// `; did you mean "…"?` for the candidate nearest to `name`, or nothing if none is near.
pub(crate) fn did_you_mean<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    let plain = |name: &str| name.to_lowercase().replace('_', "-");
    let name = plain(name);
    let unlikeness = |candidate: &&str| {
        let candidate = plain(candidate);
        let distance = strsim::damerau_levenshtein(&name, &candidate);
        // A third of the letters may be wrong, of short names half; or a whole word may be missing.
        let length = candidate.chars().count();
        let near = distance <= (length / 3).max(2.min(length / 2));
        let part = name.len() >= 3 && candidate.split('-').any(|word| word == name);
        (near || part).then_some((!near, distance))
    };
    let scored = candidates.into_iter().filter_map(|candidate| Some((unlikeness(&candidate)?, candidate)));
    let nearest = scored.min_by_key(|&(unlikeness, _)| unlikeness);
    nearest.map_or_else(String::new, |(_, candidate)| format!("; did you mean \"{candidate}\"?"))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_is_suggested_and_a_far_one_is_not() {
        assert_eq!(did_you_mean("heigth", ["normal", "height"]), "; did you mean \"height\"?");
        assert_eq!(did_you_mean("fov", ["vertical_fov", "near"]), "; did you mean \"vertical_fov\"?");
        assert_eq!(did_you_mean("Height-Scale", ["height", "height_scale"]), "; did you mean \"height_scale\"?");
        assert_eq!(did_you_mean("zzz", ["up", "near"]), "");
        assert_eq!(did_you_mean("", ["up", "near"]), "");
    }
}
