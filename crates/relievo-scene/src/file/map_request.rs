use std::path::{Path, PathBuf};

use relievo_map::{NormalY, White};
use relievo_toml::Location;

/// A map to be read, and where the scene names it.
pub(super) struct MapRequest {
    pub(super) at: Location,
    /// The key and its table, for messages.
    pub(super) what: String,
    pub(super) source: MapSource,
    /// The layer of its material's heights that it is for, if it is for one.
    pub(super) layer: Option<usize>,
}

/// The files in a folder.
pub(super) fn files_in(folder: &Path) -> Vec<PathBuf> {
    let entries = folder.read_dir().into_iter().flatten().flatten();
    entries.map(|entry| entry.path()).filter(|path| path.is_file()).collect()
}

/// The file, folder or generator that a map comes from, and the slot that it is for.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) enum MapSource {
    /// A folder; the scene file's own `normal_y` and `white` take precedence over file names.
    Folder(PathBuf, Option<NormalY>, Option<White>),
    /// A generated material at a phase of its loop (the bits of an `f64`).
    Make(String, u64),
    /// The heights alone of a recipe: a file, or a built-in one by name; texels per side.
    HeightRecipe(PathBuf, u32),
    MadeHeight(String, u32),
    BaseColor(PathBuf),
    Normal(PathBuf, NormalY),
    Height(PathBuf, White),
    Roughness(PathBuf),
    Metallic(PathBuf),
    Ao(PathBuf),
    Environment(PathBuf),
}

impl MapSource {
    /// The files that it reads; of a folder all that are in it.
    pub(super) fn files(&self) -> Vec<PathBuf> {
        match self {
            Self::Folder(path, ..) => files_in(path),
            Self::Make(..) | Self::MadeHeight(..) => Vec::new(),
            Self::HeightRecipe(path, _)
            | Self::BaseColor(path)
            | Self::Normal(path, _)
            | Self::Height(path, _)
            | Self::Roughness(path)
            | Self::Metallic(path)
            | Self::Ao(path)
            | Self::Environment(path) => vec![path.clone()],
        }
    }

    /// True if it is the same at every time.
    pub(super) fn stands_still(&self) -> bool {
        !matches!(self, Self::Make(_, phase) if *phase != 0)
    }
}
