/// The technique by which a ray is marched to the relief.
///
/// The names are those of the scene file and the command line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Technique {
    /// Flat texture, geometric normal.
    None,
    /// Flat texture, normal map.
    Normal,
    /// Parallax mapping: one sample, one step (Kaneko et al. 2001).
    Basic,
    /// Parallax mapping with offset limiting: the same without the division by V.z (Welsh 2004).
    OffsetLimiting,
    /// The parallax offset of Unity's built-in shaders: centred height, V.z raised by 0.42.
    UnityOffset,
    /// Steep parallax mapping: the first of n layers below the surface (McGuire and McGuire 2005).
    Steep,
    /// Relief mapping's bisection alone, without a linear search (after Policarpo et al. 2005).
    Binary,
    /// Relief mapping: linear search, then bisection (Policarpo et al. 2005).
    Relief,
    /// Parallax occlusion mapping: linear search, then one secant step (Brawley and Tatarchuk 2004).
    Occlusion,
    /// Contact refinement parallax mapping: linear search, then a finer one inside the last step (Riccardi 2019).
    Contact,
    /// Cone stepping: relaxed cones, finished by bisection (Policarpo and Oliveira 2007), or conservative ones, finished by the
    /// exact walk (Dummer 2006); see [`crate::Cones`].
    Cone,
    /// The first intersection with the bilinear surface, through a max pyramid: no misses, no settings.
    #[default]
    Exact,
}

impl Technique {
    /// All techniques, from the plainest to the exact one.
    pub const ALL: [Self; 12] = [
        Self::None,
        Self::Normal,
        Self::Basic,
        Self::OffsetLimiting,
        Self::UnityOffset,
        Self::Steep,
        Self::Binary,
        Self::Relief,
        Self::Occlusion,
        Self::Contact,
        Self::Cone,
        Self::Exact,
    ];

    /// Returns the name in scene files and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Normal => "normal",
            Self::Basic => "basic",
            Self::OffsetLimiting => "offset-limiting",
            Self::UnityOffset => "unity-offset",
            Self::Steep => "steep",
            Self::Binary => "binary",
            Self::Relief => "relief",
            Self::Occlusion => "occlusion",
            Self::Contact => "contact",
            Self::Cone => "cone",
            Self::Exact => "exact",
        }
    }

    /// Returns true if it looks for the surface by samples along the ray, rather than estimate it from one sample.
    pub(crate) fn samples_ray(self) -> bool {
        matches!(self, Self::Steep | Self::Binary | Self::Relief | Self::Occlusion | Self::Contact)
    }

    /// Returns true if it follows the ray over the cells, and knows the bounds of the surface.
    pub(crate) fn walks_cells(self) -> bool {
        matches!(self, Self::Cone | Self::Exact)
    }

    /// Returns the technique with this name, if there is one.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|technique| technique.name() == name)
    }
}

/// The kind of shadow that a relief throws on itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Shadow {
    /// No shadows: factor 1.
    #[default]
    None,
    /// The counting shadow of the tutorials.
    Hard,
    /// The attenuated shadow of the tutorials.
    Soft,
    /// Any hit on the way to the light, without misses; with penumbra for a light with a radius.
    Exact,
}

impl Shadow {
    /// All kinds.
    pub const ALL: [Self; 4] = [Self::None, Self::Hard, Self::Soft, Self::Exact];

    /// Returns the name in scene files and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Hard => "hard",
            Self::Soft => "soft",
            Self::Exact => "exact",
        }
    }

    /// Returns the kind with this name, if there is one.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|shadow| shadow.name() == name)
    }
}
