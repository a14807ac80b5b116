//! The maps made of a photograph.

use relievo_map::{ColorMap, HeightMap, MapSet, ScalarMap};

use super::options::PhotoOptions;

/// What [`from_photo`] makes. Normals and occlusion come from the heights when they are asked for: so all of it need never be
/// in memory at once.
#[derive(Clone, Debug, PartialEq)]
pub struct PhotoMaps {
    /// The photograph; made to tile, if that was asked for.
    pub color: ColorMap,
    /// Its heights.
    pub height: HeightMap,
    /// Roughness: more where fine light and dark differ much, and where it lies deep.
    pub roughness: ScalarMap,
}

impl PhotoMaps {
    /// All maps of the material: these, normals (+Y up) and ambient occlusion.
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
