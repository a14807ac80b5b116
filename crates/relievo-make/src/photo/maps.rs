//! The maps made of a photograph.

use relievo_map::{ColorMap, HeightMap, MapSet, ScalarMap};

use super::options::PhotoOptions;

/// The result of [`from_photo`](crate::from_photo). Normals and occlusion are derived from the heights on demand, so that
/// not all maps need to be in memory at once.
#[derive(Clone, Debug, PartialEq)]
pub struct PhotoMaps {
    /// The photograph, made to tile with [`PhotoEdge::MakeTile`](super::PhotoEdge::MakeTile).
    pub color: ColorMap,
    /// Its heights.
    pub height: HeightMap,
    /// Roughness: greater where the fine contrast is high, and where the surface is low.
    pub roughness: ScalarMap,
}

impl PhotoMaps {
    /// Derives normals (+Y up) and ambient occlusion, and returns all maps of the material.
    #[must_use]
    pub fn into_maps(self, options: &PhotoOptions) -> MapSet {
        MapSet {
            normal: Some(options.normal(&self.height)),
            ao: Some(options.ao(&self.height)),
            base_color: Some(self.color),
            height: Some(self.height),
            roughness: Some(self.roughness),
            metallic: None,
        }
    }
}
