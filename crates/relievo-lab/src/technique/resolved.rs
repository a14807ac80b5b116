use std::fmt;
use std::str::FromStr;

use relievo_march::{Bounds, MarchOptions, Technique};
use relievo_scene::{Relief, SurfaceTechnique};
use serde::{Serialize, Serializer};

use super::named::{EXACT_CELLS, NamedTechnique, note};
use super::parse::TechniqueSpecError;
use super::spec::TechniqueSpec;

/// Layers of the layered techniques in the standard list: along the normal and along the surface.
const LAYER_LADDER: [[u32; 2]; 4] = [[8, 32], [16, 64], [32, 128], [64, 256]];

/// A marching technique with all settings known, as a sweep measures it.
///
/// Parsed and written as a [`TechniqueSpec`]; open settings take the defaults of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ResolvedTechnique {
    spec: TechniqueSpec,
    technique: Technique,
}

impl ResolvedTechnique {
    /// A technique with the default settings of a scene.
    #[must_use]
    pub fn of(technique: Technique) -> Self {
        Self::resolve(TechniqueSpec::marched(technique), technique)
    }

    /// A layered technique with these layers along the normal and along the surface.
    #[must_use]
    pub fn layered(technique: Technique, layers: [u32; 2], refine_steps: Option<u32>) -> Self {
        Self::resolve(TechniqueSpec::layered(technique, layers, refine_steps), technique)
    }

    /// The exact march over every cell, without the pyramid: shows the worth of the pyramid.
    #[must_use]
    pub fn exact_cells() -> Self {
        Self { spec: TechniqueSpec::exact_cells(), technique: Technique::Exact }
    }

    /// Fills in the defaults of the settings that are open.
    fn resolve(mut spec: TechniqueSpec, technique: Technique) -> Self {
        let options = default_relief(&spec).march(1.0, Bounds::TILE);
        if spec.has_layers() {
            spec.layers = Some([options.min_layers as u32, options.max_layers as u32]);
        }
        if spec.has_refine_steps() {
            spec.refine_steps = Some(options.refine_steps);
        }
        Self { spec, technique }
    }

    /// Every technique with its defaults (`normal` but not `none`: they march alike), Bevy's rules, and the exact march
    /// over every cell.
    #[must_use]
    pub fn quick() -> Vec<Self> {
        let mut list: Vec<Self> =
            Technique::ALL.into_iter().filter(|&technique| technique != Technique::None).map(Self::of).collect();
        list.push(Self::exact_cells());
        list.extend(NamedTechnique::ALL.iter().filter_map(|named| Self::try_from(named.spec).ok()));
        sorted_unique(list)
    }

    /// [`ResolvedTechnique::quick`], and the layered techniques with twice, four and eight times the layers.
    #[must_use]
    pub fn standard() -> Vec<Self> {
        let mut list = Self::quick();
        for technique in [Technique::Steep, Technique::Occlusion, Technique::Relief, Technique::Contact] {
            list.extend(LAYER_LADDER.map(|layers| Self::layered(technique, layers, None)));
        }
        sorted_unique(list)
    }

    /// Returns true if it marches without the pyramid.
    #[must_use]
    pub fn is_cell_by_cell(&self) -> bool {
        self.spec.cell_by_cell
    }

    /// The technique.
    #[must_use]
    pub fn technique(&self) -> Technique {
        self.technique
    }

    /// The name without settings; `exact:cells` counts as a family of its own.
    #[must_use]
    pub fn family(&self) -> &'static str {
        if self.is_cell_by_cell() { EXACT_CELLS } else { self.technique.name() }
    }

    /// The specification with all settings filled in, to be applied to a scene's relief.
    #[must_use]
    pub fn spec(&self) -> TechniqueSpec {
        self.spec
    }

    /// The options of the march.
    #[must_use]
    pub fn march_options(&self) -> MarchOptions {
        default_relief(&self.spec).march(1.0, Bounds::TILE)
    }

    /// The rule that this technique is known as, for reports.
    #[must_use]
    pub fn note(&self) -> Option<&'static str> {
        note(&self.to_string())
    }
}

/// A relief with this technique and the defaults of a scene.
fn default_relief(spec: &TechniqueSpec) -> Relief {
    let mut relief = Relief::default();
    spec.apply(&mut relief);
    relief
}

/// Sorts by technique and settings, and removes duplicates.
fn sorted_unique(mut list: Vec<ResolvedTechnique>) -> Vec<ResolvedTechnique> {
    list.sort_by_key(|resolved| {
        let technique = Technique::ALL.iter().position(|&technique| technique == resolved.technique);
        (technique, !resolved.is_cell_by_cell(), resolved.spec.layers, resolved.spec.refine_steps)
    });
    list.dedup();
    list
}

impl TryFrom<TechniqueSpec> for ResolvedTechnique {
    type Error = TechniqueSpecError;

    fn try_from(spec: TechniqueSpec) -> Result<Self, Self::Error> {
        let SurfaceTechnique::Marched(technique) = spec.technique else {
            return Err(TechniqueSpecError::Displacement(spec.to_string()));
        };
        Ok(Self::resolve(spec, technique))
    }
}

impl fmt::Display for ResolvedTechnique {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.spec.fmt(f)
    }
}

/// Serialises the text form, which holds all settings.
impl Serialize for ResolvedTechnique {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl FromStr for ResolvedTechnique {
    type Err = TechniqueSpecError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Self::try_from(text.parse::<TechniqueSpec>()?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_are_read_back_as_they_are_written_and_none_comes_twice() {
        let list = ResolvedTechnique::standard();
        for (i, resolved) in list.iter().enumerate() {
            assert_eq!(resolved.to_string().parse(), Ok(*resolved));
            assert!(!list[..i].contains(resolved), "{resolved}");
        }
        for named in NamedTechnique::ALL {
            assert!(list.contains(&named.name.parse().unwrap()), "{}", named.name);
        }
        assert!(Technique::ALL[1..].iter().all(|t| list.iter().any(|resolved| resolved.technique() == *t)));
        assert!("displacement:9".parse::<ResolvedTechnique>().is_err());
        assert!("exact:cell".parse::<ResolvedTechnique>().is_err());
    }

    #[test]
    fn settings_become_those_of_the_march() {
        let march = |text: &str| text.parse::<ResolvedTechnique>().unwrap().march_options();
        let bevy = march("bevy");
        // mix(16, 1, |V.z|).
        assert_eq!((bevy.layers(1.0), bevy.layers(0.0), bevy.layers(0.5)), (1.0, 16.0, 8.5));
        assert_eq!((march("tutorials").layers(1.0), march("tutorials").layers(0.0)), (8.0, 32.0));
        assert_eq!((march("bevy-relief").refine_steps, march("binary").refine_steps), (5, 8));
        assert_eq!("relief".parse::<ResolvedTechnique>().unwrap().to_string(), "relief:8..32+5");
    }
}
