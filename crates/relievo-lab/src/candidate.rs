use std::fmt;
use std::str::FromStr;

use glam::Vec2;
use relievo_march::{MarchOptions, Technique};
use relievo_scene::{Relief, SurfaceTechnique};
use thiserror::Error;

use crate::{Contender, ContenderError};

/// Layers at which the layered techniques are swept: along the normal and along the surface.
const LADDER: [[u32; 2]; 4] = [[8, 32], [16, 64], [32, 128], [64, 256]];

/// A marching technique with all of its settings, as a sweep measures it.
///
/// Written as a [`Contender`], or `exact:cells`: the exact march cell by cell, without the pyramid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Candidate {
    contender: Contender,
    technique: Technique,
    cells: bool,
}

/// Why a text names no [`Candidate`].
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum CandidateError {
    /// It names no technique.
    #[error(transparent)]
    Contender(#[from] ContenderError),
    /// Displaced geometry is not marched.
    #[error("\"{0}\" is geometry, not a march: displaced grids are judged by `relievo compare`")]
    Displacement(String),
}

impl Candidate {
    /// The exact march cell by cell.
    const CELLS: &'static str = "exact:cells";

    /// A technique with the settings that are its defaults in a scene.
    #[must_use]
    pub fn of(technique: Technique) -> Self {
        Self::settled(Contender::of(SurfaceTechnique::Marched(technique)), technique)
    }

    /// A layered technique with these layers along the normal and along the surface.
    #[must_use]
    pub fn layered(technique: Technique, layers: [u32; 2], refine_steps: Option<u32>) -> Self {
        Self::settled(Contender::layered(technique, layers, refine_steps), technique)
    }

    /// The exact march through the cells alone, without the pyramid: what the pyramid is worth.
    #[must_use]
    pub fn cell_by_cell() -> Self {
        Self { cells: true, ..Self::of(Technique::Exact) }
    }

    /// Fills in the defaults of what the contender leaves open.
    fn settled(mut contender: Contender, technique: Technique) -> Self {
        let options = relief(&contender).march(1.0, Vec2::ONE);
        if contender.has_layers() {
            contender.layers = Some([options.min_layers as u32, options.max_layers as u32]);
        }
        if contender.has_refine_steps() {
            contender.refine_steps = Some(options.refine_steps);
        }
        Self { contender, technique, cells: false }
    }

    /// Every technique with its defaults (of `none` and `normal`, which march alike, the latter), Bevy's rules, and the
    /// exact march cell by cell.
    #[must_use]
    pub fn quick() -> Vec<Self> {
        let mut list: Vec<Self> =
            Technique::ALL.into_iter().filter(|&technique| technique != Technique::None).map(Self::of).collect();
        list.push(Self::cell_by_cell());
        list.extend(Contender::NAMED.iter().filter_map(|(_, contender)| Self::try_from(*contender).ok()));
        list.dedup();
        unique(list)
    }

    /// [`Candidate::quick`], and the layered techniques with twice, four and eight times the layers.
    #[must_use]
    pub fn standard() -> Vec<Self> {
        let mut list = Self::quick();
        for technique in [Technique::Steep, Technique::Occlusion, Technique::Relief, Technique::Contact] {
            list.extend(LADDER.map(|layers| Self::layered(technique, layers, None)));
        }
        unique(list)
    }

    /// Whether it marches without the pyramid.
    #[must_use]
    pub fn is_cell_by_cell(&self) -> bool {
        self.cells
    }

    /// The technique.
    #[must_use]
    pub fn technique(&self) -> Technique {
        self.technique
    }

    /// Its name without settings: `exact:cells` has one of its own.
    #[must_use]
    pub fn family(&self) -> &'static str {
        if self.cells { Self::CELLS } else { self.technique.name() }
    }

    /// What is put into a scene's material.
    #[must_use]
    pub fn contender(&self) -> Contender {
        self.contender
    }

    /// How to march.
    #[must_use]
    pub fn march(&self) -> MarchOptions {
        relief(&self.contender).march(1.0, Vec2::ONE)
    }

    /// What it is known as, if it is a rule of somebody's.
    #[must_use]
    pub fn note(&self) -> Option<&'static str> {
        match self.to_string().as_str() {
            Self::CELLS => Some("the exact walk over every cell"),
            "exact" => Some("the default here"),
            "occlusion:8..32" => Some("the tutorials' rule"),
            "occlusion:1..16" => Some("Bevy's rule"),
            "relief:1..16+5" => Some("Bevy's relief mapping"),
            _ => None,
        }
    }
}

/// A relief drawn by this contender, with defaults where it says nothing.
fn relief(contender: &Contender) -> Relief {
    let mut relief = Relief::default();
    contender.apply(&mut relief);
    relief
}

/// Each once, in the order of the techniques and of their settings.
fn unique(mut list: Vec<Candidate>) -> Vec<Candidate> {
    let place = |candidate: &Candidate| {
        let technique = Technique::ALL.iter().position(|&technique| technique == candidate.technique);
        (technique, !candidate.cells, candidate.contender.layers, candidate.contender.refine_steps)
    };
    list.sort_by_key(place);
    list.dedup();
    list
}

impl TryFrom<Contender> for Candidate {
    type Error = CandidateError;

    fn try_from(contender: Contender) -> Result<Self, Self::Error> {
        match contender.technique {
            SurfaceTechnique::Marched(technique) => Ok(Self::settled(contender, technique)),
            SurfaceTechnique::Displacement => Err(CandidateError::Displacement(contender.to_string())),
        }
    }
}

impl fmt::Display for Candidate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.cells { f.write_str(Self::CELLS) } else { self.contender.fmt(f) }
    }
}

impl FromStr for Candidate {
    type Err = CandidateError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        if text == Self::CELLS { Ok(Self::cell_by_cell()) } else { Self::try_from(text.parse::<Contender>()?) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_are_read_back_as_they_are_written_and_none_comes_twice() {
        let list = Candidate::standard();
        for (i, candidate) in list.iter().enumerate() {
            assert_eq!(candidate.to_string().parse(), Ok(*candidate));
            assert!(!list[..i].contains(candidate), "{candidate}");
        }
        for (name, _) in Contender::NAMED {
            assert!(list.contains(&name.parse().unwrap()), "{name}");
        }
        assert!(Technique::ALL[1..].iter().all(|t| list.iter().any(|candidate| candidate.technique() == *t)));
        assert!("displacement:9".parse::<Candidate>().is_err() && "exact:cell".parse::<Candidate>().is_err());
    }

    #[test]
    fn settings_become_those_of_the_march() {
        let march = |text: &str| text.parse::<Candidate>().unwrap().march();
        let bevy = march("bevy");
        // mix(16, 1, |V.z|).
        assert_eq!((bevy.layers(1.0), bevy.layers(0.0), bevy.layers(0.5)), (1.0, 16.0, 8.5));
        assert_eq!((march("tutorials").layers(1.0), march("tutorials").layers(0.0)), (8.0, 32.0));
        assert_eq!((march("bevy-relief").refine_steps, march("binary").refine_steps), (5, 8));
        assert_eq!("relief".parse::<Candidate>().unwrap().to_string(), "relief:8..32+5");
    }
}
