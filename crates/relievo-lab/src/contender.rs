use std::fmt;
use std::str::FromStr;

use relievo_march::{MAX_LAYERS, MAX_REFINE_STEPS, Technique};
use relievo_scene::{Relief, SurfaceTechnique};
use thiserror::Error;

/// What is compared: a technique, and where it has settings those that differ from the scene's.
///
/// Written `relief`, `occlusion:8..32` (layers), `relief:8..32+5` (and bisections), `binary:8` (bisections),
/// `displacement:100` (vertices per side), or by one of the [`Contender::NAMED`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contender {
    /// How the surface is found.
    pub technique: SurfaceTechnique,
    /// Vertices per side, for `displacement` only; `None`: as the scene says.
    pub grid: Option<u32>,
    /// Layers along the normal and along the surface, for the layered techniques only; `None`: as the scene says.
    pub layers: Option<[u32; 2]>,
    /// Bisections, for `relief` and `binary` only; `None`: as the scene says.
    pub refine_steps: Option<u32>,
}

impl Contender {
    /// Rules with a name of their own. The tutorials take `mix(32, 8, |V.z|)` layers. Bevy 0.19 takes `mix(16, 1, |V.z|)`
    /// (`max_parallax_layer_count` 16), in its relief mapping with 5 bisections after them.
    pub const NAMED: [(&'static str, Self); 3] = [
        ("tutorials", Self::layered(Technique::Occlusion, [8, 32], None)),
        ("bevy", Self::layered(Technique::Occlusion, [1, 16], None)),
        ("bevy-relief", Self::layered(Technique::Relief, [1, 16], Some(5))),
    ];

    /// A technique as the scene has it.
    #[must_use]
    pub const fn of(technique: SurfaceTechnique) -> Self {
        Self { technique, grid: None, layers: None, refine_steps: None }
    }

    /// A layered technique with these layers along the normal and along the surface.
    #[must_use]
    pub const fn layered(technique: Technique, layers: [u32; 2], refine_steps: Option<u32>) -> Self {
        Self { layers: Some(layers), refine_steps, ..Self::of(SurfaceTechnique::Marched(technique)) }
    }

    /// Every marching technique, and the tutorials' coarse and fine displaced grids.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let marched = Technique::ALL.into_iter().map(|t| Self::of(SurfaceTechnique::Marched(t)));
        let displaced = [10, 100].map(|grid| Self { grid: Some(grid), ..Self::of(SurfaceTechnique::Displacement) });
        marched.chain(displaced).collect()
    }

    /// Whether it searches in layers.
    #[must_use]
    pub fn has_layers(&self) -> bool {
        use Technique::{Contact, Occlusion, Relief, Steep};
        matches!(self.technique, SurfaceTechnique::Marched(Steep | Relief | Occlusion | Contact))
    }

    /// Whether it bisects.
    #[must_use]
    pub fn has_refine_steps(&self) -> bool {
        matches!(self.technique, SurfaceTechnique::Marched(Technique::Relief | Technique::Binary))
    }

    /// Puts it in place of a relief's technique; what it leaves open stays as it is.
    pub fn apply(&self, relief: &mut Relief) {
        relief.technique = self.technique;
        relief.grid = self.grid.unwrap_or(relief.grid);
        if let Some([min, max]) = self.layers {
            (relief.min_layers, relief.max_layers) = (min as f32, max as f32);
        }
        relief.refine_steps = self.refine_steps.or(relief.refine_steps);
    }
}

impl fmt::Display for Contender {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.technique.name())?;
        match (self.grid, self.layers, self.refine_steps) {
            (Some(grid), _, _) => write!(f, ":{grid}"),
            (_, Some([min, max]), Some(steps)) => write!(f, ":{min}..{max}+{steps}"),
            (_, Some([min, max]), None) => write!(f, ":{min}..{max}"),
            (_, None, Some(steps)) => write!(f, ":{steps}"),
            (None, None, None) => Ok(()),
        }
    }
}

/// Why a text names no [`Contender`].
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("\"{text}\" is not a technique; {}", Self::expected())]
pub struct ContenderError {
    /// The text.
    pub text: String,
}

impl ContenderError {
    /// What would have been understood.
    #[must_use]
    pub fn expected() -> String {
        let named: Vec<&str> = Contender::NAMED.iter().map(|(name, _)| *name).collect();
        format!(
            "expected one of {}, {}; settings may follow: occlusion:8..32 (layers; steep and contact likewise), \
             relief:8..32+5 (and bisections), binary:8, displacement:N with N vertices per side, 2 to 8192",
            SurfaceTechnique::names().collect::<Vec<_>>().join(", "),
            named.join(", ")
        )
    }
}

impl FromStr for Contender {
    type Err = ContenderError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        if let Some((_, contender)) = Self::NAMED.iter().find(|(name, _)| *name == text) {
            return Ok(*contender);
        }
        let refused = || ContenderError { text: text.to_owned() };
        let (name, settings) = match text.split_once(':') {
            Some((name, settings)) => (name, Some(settings)),
            None => (text, None),
        };
        let plain = Self::of(SurfaceTechnique::from_name(name).ok_or_else(refused)?);
        match settings {
            None => Some(plain),
            Some(settings) => plain.with_settings(settings),
        }
        .ok_or_else(refused)
    }
}

impl Contender {
    fn with_settings(self, text: &str) -> Option<Self> {
        let whole = |text: &str, min: u32, max: u32| text.parse().ok().filter(|n| (min..=max).contains(n));
        if self.technique == SurfaceTechnique::Displacement {
            return Some(Self { grid: Some(whole(text, 2, 8192)?), ..self });
        }
        if !self.has_layers() {
            let steps = whole(text, 0, MAX_REFINE_STEPS).filter(|_| self.has_refine_steps())?;
            return Some(Self { refine_steps: Some(steps), ..self });
        }
        let (layers, steps) = match text.split_once('+') {
            Some((layers, steps)) if self.has_refine_steps() => (layers, Some(whole(steps, 0, MAX_REFINE_STEPS)?)),
            Some(_) => return None,
            None => (text, None),
        };
        let (min, max) = layers.split_once("..")?;
        let max = whole(max, 1, MAX_LAYERS as u32)?;
        Some(Self { layers: Some([whole(min, 1, max)?, max]), refine_steps: steps, ..self })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_back_as_they_are_written() {
        let settings =
            ["steep:1..4096", "relief:8..32", "relief:8..32+5", "binary:0", "contact:3..3", "occlusion:1..16"];
        let settings = settings.map(|text| text.parse().unwrap());
        for contender in Contender::all().into_iter().chain(Contender::NAMED.map(|(_, c)| c)).chain(settings) {
            assert_eq!(contender.to_string().parse(), Ok(contender));
        }
        assert_eq!("displacement".parse::<Contender>().map(|c| c.grid), Ok(None));
        assert_eq!("bevy".parse::<Contender>().map(|c| c.to_string()), Ok("occlusion:1..16".to_owned()));
        for bad in ["", "relif", "displacement:", "displacement:1", "displacement:9000", "displacement:x"] {
            assert!(bad.parse::<Contender>().is_err(), "{bad}");
        }
    }

    #[test]
    fn settings_that_a_technique_has_not_or_that_are_out_of_range_are_refused() {
        for bad in [
            "relief:5",
            "exact:8..32",
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
            assert!(bad.parse::<Contender>().is_err(), "{bad}");
        }
    }

    #[test]
    fn what_is_left_open_stays_as_the_scene_has_it() {
        let mut relief = Relief { grid: 7, min_layers: 3.0, refine_steps: Some(9), ..Relief::default() };
        Contender::of(SurfaceTechnique::Displacement).apply(&mut relief);
        assert_eq!((relief.grid, relief.min_layers, relief.refine_steps), (7, 3.0, Some(9)));
        Contender::layered(Technique::Relief, [4, 20], None).apply(&mut relief);
        assert_eq!((relief.min_layers, relief.max_layers, relief.refine_steps), (4.0, 20.0, Some(9)));
    }
}
