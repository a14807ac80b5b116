use relievo_cpu::RenderError;
use thiserror::Error;

use crate::metric::FlipError;
use crate::technique::TechniqueSpec;

/// Progress callback: (next picture, pictures done, pictures in all).
pub type CompareProgress<'a> = dyn Fn(&str, usize, usize) + Sync + 'a;

/// Options of a comparison.
#[derive(Clone)]
pub struct CompareOptions<'a> {
    /// Techniques, in the order of the sheet.
    pub techniques: Vec<TechniqueSpec>,
    /// Vertices per side of the truth's picture; `None`: two per texel, however many that are. Hits are judged by a finer
    /// surface whatever this is.
    pub grid: Option<u32>,
    /// Threads to use; `None`: all cores.
    pub threads: Option<usize>,
    /// Called before each picture.
    pub progress: Option<&'a CompareProgress<'a>>,
}

impl Default for CompareOptions<'_> {
    fn default() -> Self {
        Self { techniques: TechniqueSpec::all(), grid: None, threads: None, progress: None }
    }
}

/// An error of a comparison.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CompareError {
    /// No object of the scene has a height map.
    #[error(
        "no object has a material with a height map, so there is no relief to compare; give a material height = \"FILE\", \
         or from = a folder with a height map"
    )]
    NoRelief,
    /// An object of the scene is a medium.
    #[error(
        "material \"{name}\" is mist, which has no surface that techniques could hit: a comparison judges hits; leave its \
         objects out of the scene to compare the reliefs, or draw it with `relievo render`"
    )]
    Mist {
        /// Name of the material.
        name: String,
    },
    /// The renderer marches with the pyramid only.
    #[error("exact:cells cannot be drawn: the walk over every cell is measured by `relievo lab`")]
    CellByCell,
    /// A picture could not be drawn.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// Pictures could not be judged.
    #[error(transparent)]
    Flip(#[from] FlipError),
}
