//! Presets for common materials.

use super::options::{BANDS, PhotoEdge, PhotoOptions};

/// Weights for a kind of material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum PhotoPreset {
    /// Bricks or stones in mortar that is greyer than they are, dark or light; fine cracks are deep.
    Brick,
    /// Stones, gravel, soil: dark is deep, and coarse bands weigh more, as fine brightness shows slopes rather than heights.
    #[default]
    Stone,
    /// Grain: fine dark lines.
    Wood,
    /// Threads: the finest bands.
    Fabric,
    /// Dark cracks on a plain that is otherwise left alone.
    Cracks,
}

impl PhotoPreset {
    /// All presets and their names.
    pub const ALL: [(&'static str, Self); 5] = [
        ("brick", Self::Brick),
        ("stone", Self::Stone),
        ("wood", Self::Wood),
        ("fabric", Self::Fabric),
        ("cracks", Self::Cracks),
    ];

    /// Returns the options of this preset: an open border, no picks, no mask.
    #[must_use]
    pub fn options(self) -> PhotoOptions {
        let none = [0.0; BANDS];
        let (light, saturation, height_scale, roughness) = match self {
            Self::Brick => ([0.10, 0.10, 0.10, 0.05, 0.0, 0.0, 0.0], [0.0, 0.0, 0.4, 1.0, 1.0, 1.0, 1.0], 0.04, 0.85),
            Self::Stone => ([0.02, 0.03, 0.08, 0.28, 0.6, 1.0, 1.0], none, 0.06, 0.85),
            Self::Wood => ([0.5, 0.8, 1.0, 0.8, 0.4, 0.1, 0.0], none, 0.01, 0.6),
            Self::Fabric => ([0.8, 1.0, 1.0, 0.7, 0.3, 0.0, 0.0], none, 0.01, 0.9),
            Self::Cracks => ([0.4, 0.7, 1.0, 1.0, 0.6, 0.3, 0.0], none, 0.03, 0.9),
        };
        PhotoOptions {
            flatten: 0.0625,
            light,
            saturation,
            dark_only: self == Self::Cracks,
            side_light: None,
            picks: Vec::new(),
            mask: None,
            clean: 0.002,
            levels: [0.5, 99.5],
            edge: PhotoEdge::Open,
            height_scale,
            roughness,
        }
    }
}
