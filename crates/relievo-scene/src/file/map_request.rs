use std::path::PathBuf;

use relievo_map::{NormalY, White};
use relievo_toml::Location;

/// A map to be read, and where the scene names it.
pub(super) struct MapRequest {
    pub(super) at: Location,
    /// The key and its table, for messages.
    pub(super) what: String,
    pub(super) source: MapSource,
}

/// The file, folder or generator that a map comes from, and the slot that it is for.
pub(super) enum MapSource {
    /// A folder; the scene file's own `normal_y` and `white` take precedence over file names.
    Folder(PathBuf, Option<NormalY>, Option<White>),
    Make(String),
    BaseColor(PathBuf),
    Normal(PathBuf, NormalY),
    Height(PathBuf, White),
    Roughness(PathBuf),
    Metallic(PathBuf),
    Ao(PathBuf),
    Environment(PathBuf),
}
