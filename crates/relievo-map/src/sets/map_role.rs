//! The uses of maps.

use crate::types::{Channel, NormalY};

/// The use of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum MapRole {
    BaseColor,
    /// `None`: the name does not tell which way Y points.
    Normal(Option<NormalY>),
    Height(HeightKind),
    Roughness,
    /// 1 − roughness.
    Gloss,
    Metallic,
    Ao,
    /// Several maps in the channels of one file.
    Packed(PackedChannels),
    /// A known kind that is not used; the reason, as the end of a sentence.
    Unused(&'static str),
}

/// The sort of height in a file, the best last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum HeightKind {
    /// White is deep.
    Depth,
    /// Often only fine detail.
    Bump,
    Displacement,
}

/// The channel of each map in a packed file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct PackedChannels {
    pub(super) ao: Option<Channel>,
    pub(super) roughness: Option<Channel>,
    pub(super) metallic: Option<Channel>,
    /// The channel of the roughness holds smoothness: 1 − roughness.
    pub(super) smooth: bool,
}

impl PackedChannels {
    /// Occlusion, roughness, metallic: Poly Haven's `arm`, Unreal's `ORM`.
    pub(super) const ARM: Self =
        Self { ao: Some(Channel::Red), roughness: Some(Channel::Green), metallic: Some(Channel::Blue), smooth: false };
}
