//! The maps of a material that files compete for, and the ranks of the competitors.

use super::map_role::{HeightKind, MapRole};
use crate::types::{Channel, NormalY};

/// The maps of a [`MapSet`](crate::MapSet).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum MapSlot {
    BaseColor,
    Normal,
    Height,
    Roughness,
    Metallic,
    Ao,
}

impl MapSlot {
    pub(super) const ALL: [Self; 6] =
        [Self::BaseColor, Self::Normal, Self::Height, Self::Roughness, Self::Metallic, Self::Ao];

    /// The name for notes.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::BaseColor => "base colour",
            Self::Normal => "normals",
            Self::Height => "height",
            Self::Roughness => "roughness",
            Self::Metallic => "metallic",
            Self::Ao => "ambient occlusion",
        }
    }
}

/// Rank of a role in a slot (higher is better) and the channel that holds it; `None` if it does not fit.
pub(super) fn fit(role: MapRole, slot: MapSlot) -> Option<(u32, Channel)> {
    let whole = |rank| Some((rank, Channel::Luminance));
    match (slot, role) {
        (MapSlot::BaseColor, MapRole::BaseColor) => whole(2),
        (MapSlot::Normal, MapRole::Normal(Some(NormalY::Up))) => whole(2),
        (MapSlot::Normal, MapRole::Normal(Some(NormalY::Down))) => whole(1),
        (MapSlot::Normal, MapRole::Normal(None)) => whole(0),
        (MapSlot::Height, MapRole::Height(HeightKind::Displacement)) => whole(2),
        (MapSlot::Height, MapRole::Height(HeightKind::Bump)) => whole(1),
        (MapSlot::Height, MapRole::Height(HeightKind::Depth)) => whole(0),
        (MapSlot::Metallic, MapRole::Metallic) | (MapSlot::Ao, MapRole::Ao) => whole(2),
        (MapSlot::Roughness, MapRole::Roughness) => whole(3),
        (MapSlot::Roughness, MapRole::Gloss) => whole(1),
        (MapSlot::Roughness, MapRole::Packed(packed)) => {
            packed.roughness.map(|channel| (if packed.smooth { 0 } else { 2 }, channel))
        }
        (MapSlot::Metallic, MapRole::Packed(packed)) => packed.metallic.map(|channel| (1, channel)),
        (MapSlot::Ao, MapRole::Packed(packed)) => packed.ao.map(|channel| (1, channel)),
        _ => None,
    }
}

/// Rank of a file format by what it keeps of such a map: higher keeps more.
pub(super) fn precision(slot: MapSlot, extension: &str) -> usize {
    let order: &[&str] = match slot {
        MapSlot::Height | MapSlot::Normal => &["jpg", "jpeg", "webp", "bmp", "tga", "hdr", "png", "tif", "tiff", "exr"],
        // 8 bits are enough for these, so that only what JPEG loses counts.
        _ => &["hdr", "exr", "jpg", "jpeg", "webp", "bmp", "tga", "tif", "tiff", "png"],
    };
    order.iter().position(|e| *e == extension).unwrap_or(0)
}
