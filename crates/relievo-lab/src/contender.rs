use std::fmt;
use std::str::FromStr;

use relievo_march::Technique;
use relievo_scene::SurfaceTechnique;
use thiserror::Error;

/// What is compared: a technique, and for `displacement` how fine a grid.
///
/// Written `relief`, `displacement` (with the scene's own grid) or `displacement:100`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contender {
    /// How the surface is found.
    pub technique: SurfaceTechnique,
    /// Vertices per side, for `displacement` only; `None`: as the scene says.
    pub grid: Option<u32>,
}

impl Contender {
    /// Every marching technique, and the tutorials' coarse and fine displaced grids.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let marched = Technique::ALL.into_iter().map(|t| Self { technique: SurfaceTechnique::March(t), grid: None });
        let displaced = [10, 100].map(|grid| Self { technique: SurfaceTechnique::Displacement, grid: Some(grid) });
        marched.chain(displaced).collect()
    }
}

impl fmt::Display for Contender {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.grid {
            Some(grid) => write!(f, "{}:{grid}", self.technique.name()),
            None => f.write_str(self.technique.name()),
        }
    }
}

/// Why a text names no [`Contender`].
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error(
    "\"{text}\" is not a technique; expected one of {}, or displacement:N with N vertices per side, 2 to 8192",
    SurfaceTechnique::names().collect::<Vec<_>>().join(", ")
)]
pub struct ContenderError {
    /// The text.
    pub text: String,
}

impl FromStr for Contender {
    type Err = ContenderError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let refused = || ContenderError { text: text.to_owned() };
        let (name, grid) = match text.split_once(':') {
            Some((name, grid)) => (name, Some(grid.parse().map_err(|_| refused())?)),
            None => (text, None),
        };
        let technique = SurfaceTechnique::from_name(name).ok_or_else(refused)?;
        let grid_fits =
            grid.is_none_or(|n: u32| technique == SurfaceTechnique::Displacement && (2..=8192).contains(&n));
        if grid_fits { Ok(Self { technique, grid }) } else { Err(refused()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_back_as_they_are_written() {
        for contender in Contender::all() {
            assert_eq!(contender.to_string().parse(), Ok(contender));
        }
        assert_eq!("displacement".parse::<Contender>().map(|c| c.grid), Ok(None));
        for bad in ["", "relif", "relief:5", "displacement:", "displacement:1", "displacement:9000", "displacement:x"] {
            assert!(bad.parse::<Contender>().is_err(), "{bad}");
        }
    }
}
