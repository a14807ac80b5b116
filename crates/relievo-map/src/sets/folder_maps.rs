use std::path::PathBuf;

use crate::types::{Channel, NormalY, White};

/// The files of a folder that hold the maps of its material.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FolderMaps {
    /// Base colour.
    pub base_color: Option<PathBuf>,
    /// Normals and the direction of their +Y: down for Unreal's `T_…_N`; up is assumed where the name does not tell.
    pub normal: Option<(PathBuf, NormalY)>,
    /// Heights.
    pub height: Option<PathBuf>,
    /// The meaning of white in the height file: deep for a depth map, else high.
    pub height_white: White,
    /// Roughness, and the channel that holds it.
    pub roughness: Option<(PathBuf, Channel)>,
    /// The roughness channel holds glossiness: roughness is 1 − its value.
    pub roughness_is_gloss: bool,
    /// Metallic, and the channel that holds it.
    pub metallic: Option<(PathBuf, Channel)>,
    /// Ambient occlusion, and the channel that holds it.
    pub ao: Option<(PathBuf, Channel)>,
    /// Notes in whole sentences: files found, files ignored, and why.
    pub notes: Vec<String>,
}
