use relievo_march::Technique;

/// Techniques that find the surface: a march through the height field, or displaced geometry.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SurfaceTechnique {
    /// A technique that marches (or ignores) the height field.
    Marched(Technique),
    /// A grid of vertices moved along the normal: `displacement`.
    Displacement,
}

impl Default for SurfaceTechnique {
    fn default() -> Self {
        Self::Marched(Technique::Exact)
    }
}

impl SurfaceTechnique {
    /// Returns the name in scene files and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Marched(technique) => technique.name(),
            Self::Displacement => "displacement",
        }
    }

    /// Returns the technique with this name, if there is one.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        if name == "displacement" { Some(Self::Displacement) } else { Technique::from_name(name).map(Self::Marched) }
    }

    /// Returns the technique if it marches a height field: not `none` and `normal`, which ignore it, nor displacement.
    #[must_use]
    pub fn marched(self) -> Option<Technique> {
        match self {
            Self::Marched(Technique::None | Technique::Normal) | Self::Displacement => None,
            Self::Marched(technique) => Some(technique),
        }
    }

    /// Returns true if nothing is seen of the technique without a height map.
    #[must_use]
    pub fn needs_heights(self) -> bool {
        self == Self::Displacement || self.marched().is_some()
    }

    /// Returns true if shading uses the mesh's own normals, whatever maps there are: `none`.
    #[must_use]
    pub fn shades_flat(self) -> bool {
        self == Self::Marched(Technique::None)
    }

    /// Returns all names, in the order of [`Technique::ALL`] with `displacement` last.
    pub fn names() -> impl Iterator<Item = &'static str> {
        Technique::ALL.into_iter().map(Technique::name).chain(["displacement"])
    }
}
