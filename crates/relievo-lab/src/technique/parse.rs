use std::str::FromStr;

use relievo_march::{MAX_LAYERS, MAX_REFINE_STEPS, Technique};
use relievo_scene::SurfaceTechnique;
use thiserror::Error;

use super::named::NamedTechnique;
use super::spec::TechniqueSpec;

/// An error in the specification of a technique.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum TechniqueSpecError {
    /// The text names no technique with settings.
    #[error("\"{text}\" is not a technique; {}", Self::expected())]
    Unknown {
        /// The text.
        text: String,
    },
    /// Displaced geometry is not marched, so it cannot be resolved for a sweep.
    #[error("\"{0}\" is geometry, not a march: displaced grids are judged by `relievo compare`")]
    Displacement(String),
}

impl TechniqueSpecError {
    /// The part of the message that lists the accepted texts.
    #[must_use]
    pub fn expected() -> String {
        format!(
            "expected one of {}, {}; settings may follow: occlusion:8..32 (layers; steep and contact likewise), \
             relief:8..32+5 (and bisections), binary:8, displacement:N with N vertices per side, 2 to 8192",
            SurfaceTechnique::names().collect::<Vec<_>>().join(", "),
            NamedTechnique::ALL.map(|named| named.name).join(", ")
        )
    }
}

impl FromStr for TechniqueSpec {
    type Err = TechniqueSpecError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        parse(text).ok_or_else(|| TechniqueSpecError::Unknown { text: text.to_owned() })
    }
}

fn parse(text: &str) -> Option<TechniqueSpec> {
    if let Some(named) = NamedTechnique::ALL.iter().find(|named| named.name == text) {
        return Some(named.spec);
    }
    match text.split_once(':') {
        Some((name, settings)) => with_settings(TechniqueSpec::of(SurfaceTechnique::from_name(name)?), settings),
        None => SurfaceTechnique::from_name(text).map(TechniqueSpec::of),
    }
}

fn with_settings(spec: TechniqueSpec, text: &str) -> Option<TechniqueSpec> {
    if spec.technique == SurfaceTechnique::Displacement {
        return Some(TechniqueSpec { grid: Some(whole(text, 2, 8192)?), ..spec });
    }
    if spec.technique == SurfaceTechnique::Marched(Technique::Exact) && text == "cells" {
        return Some(TechniqueSpec { cell_by_cell: true, ..spec });
    }
    if !spec.has_layers() {
        let steps = whole(text, 0, MAX_REFINE_STEPS).filter(|_| spec.has_refine_steps())?;
        return Some(TechniqueSpec { refine_steps: Some(steps), ..spec });
    }
    let (layers, refine_steps) = match text.split_once('+') {
        Some((layers, steps)) if spec.has_refine_steps() => (layers, Some(whole(steps, 0, MAX_REFINE_STEPS)?)),
        Some(_) => return None,
        None => (text, None),
    };
    let (min, max) = layers.split_once("..")?;
    let max = whole(max, 1, MAX_LAYERS as u32)?;
    Some(TechniqueSpec { layers: Some([whole(min, 1, max)?, max]), refine_steps, ..spec })
}

/// Parses a whole number from `min` to `max`.
fn whole(text: &str, min: u32, max: u32) -> Option<u32> {
    text.parse().ok().filter(|n| (min..=max).contains(n))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_back_as_they_are_written() {
        let settings =
            ["steep:1..4096", "relief:8..32", "relief:8..32+5", "binary:0", "contact:3..3", "occlusion:1..16"];
        let settings = settings.map(|text| text.parse().unwrap());
        let named = NamedTechnique::ALL.map(|named| named.spec);
        for spec in TechniqueSpec::all().into_iter().chain(named).chain(settings).chain([TechniqueSpec::exact_cells()])
        {
            assert_eq!(spec.to_string().parse(), Ok(spec));
        }
        assert_eq!("displacement".parse::<TechniqueSpec>().map(|c| c.grid), Ok(None));
        assert_eq!("bevy".parse::<TechniqueSpec>().map(|c| c.to_string()), Ok("occlusion:1..16".to_owned()));
        for bad in ["", "relif", "displacement:", "displacement:1", "displacement:9000", "displacement:x"] {
            assert!(bad.parse::<TechniqueSpec>().is_err(), "{bad}");
        }
    }

    #[test]
    fn settings_that_a_technique_has_not_or_that_are_out_of_range_are_refused() {
        for bad in [
            "relief:5",
            "exact:8..32",
            "exact:cell",
            "cone:cells",
            "none:1",
            "occlusion:8..32+5",
            "occlusion:32..8",
            "occlusion:0..8",
            "steep:8",
            "steep:8..5000",
            "binary:65",
            "binary:8..32",
            "relief:8..32+",
            "relief:8..32+99",
            "relief:..",
            "basic:",
        ] {
            assert!(bad.parse::<TechniqueSpec>().is_err(), "{bad}");
        }
    }
}
