/// The kinds of cones that [`crate::Technique::Cone`] steps through.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Cones {
    /// A ray that leaves the cone's cell meets the surface at most once inside the cone (Policarpo and Oliveira 2007): it
    /// may step through the surface, and bisections find the crossing.
    #[default]
    Relaxed,
    /// Nothing of the surface is inside the cone (Dummer 2006): no step passes a hit.
    Conservative,
}

impl Cones {
    /// Both kinds.
    pub const ALL: [Self; 2] = [Self::Relaxed, Self::Conservative];

    /// Returns the name in scene files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Relaxed => "relaxed",
            Self::Conservative => "conservative",
        }
    }

    /// Returns the kind with this name, if there is one.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|cones| cones.name() == name)
    }
}
