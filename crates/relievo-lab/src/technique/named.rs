use relievo_march::Technique;

use super::spec::TechniqueSpec;

/// The exact march.
pub(crate) const EXACT: &str = "exact";

/// The exact march over every cell.
pub(crate) const EXACT_CELLS: &str = "exact:cells";

/// The layers of the tutorials' parallax occlusion mapping.
pub(crate) const TUTORIALS: &str = "occlusion:8..32";

/// The layers of Bevy's parallax occlusion mapping.
pub(crate) const BEVY: &str = "occlusion:1..16";

/// The layers and bisections of Bevy's relief mapping.
const BEVY_RELIEF: &str = "relief:1..16+5";

/// A technique with settings that has a name of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NamedTechnique {
    /// The name, as the command line takes it.
    pub name: &'static str,
    /// The technique with its settings.
    pub spec: TechniqueSpec,
}

impl NamedTechnique {
    /// All named techniques. The tutorials take `mix(32, 8, |V.z|)` layers. Bevy 0.19 takes `mix(16, 1, |V.z|)`
    /// (`max_parallax_layer_count` 16), in its relief mapping with 5 bisections after them.
    pub const ALL: [Self; 3] = [
        Self { name: "tutorials", spec: TechniqueSpec::layered(Technique::Occlusion, [8, 32], None) },
        Self { name: "bevy", spec: TechniqueSpec::layered(Technique::Occlusion, [1, 16], None) },
        Self { name: "bevy-relief", spec: TechniqueSpec::layered(Technique::Relief, [1, 16], Some(5)) },
    ];
}

/// The note that reports print beside a technique, by its [`Display`](std::fmt::Display) form.
pub(super) fn note(technique: &str) -> Option<&'static str> {
    match technique {
        EXACT_CELLS => Some("the exact walk over every cell"),
        EXACT => Some("the default here"),
        TUTORIALS => Some("the tutorials' rule"),
        BEVY => Some("Bevy's rule"),
        BEVY_RELIEF => Some("Bevy's relief mapping"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_and_specifications_agree() {
        assert_eq!(NamedTechnique::ALL.map(|named| named.spec.to_string()), [TUTORIALS, BEVY, BEVY_RELIEF]);
        assert_eq!(TechniqueSpec::marched(Technique::Exact).to_string(), EXACT);
        assert_eq!(TechniqueSpec::exact_cells().to_string(), EXACT_CELLS);
    }
}
