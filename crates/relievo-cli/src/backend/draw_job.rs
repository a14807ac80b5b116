//! Input and output of every backend.

use relievo_map::Grid;
use relievo_scene::{Aovs, Scene};

/// A scene to draw, and the results that are wanted.
// Only GPUs have to be told what is wanted: the CPU measures and times all that it draws.
#[cfg_attr(not(feature = "gpu"), allow(dead_code))]
pub(crate) struct DrawJob<'a> {
    pub(crate) scene: &'a Scene,
    /// Name of the scene in errors.
    pub(crate) name: String,
    /// Threads of the CPU: those asked for, and those there will be.
    pub(crate) threads: (Option<usize>, usize),
    pub(crate) frames: u32,
    /// True if times are wanted.
    pub(crate) timed: bool,
    /// True if AOVs are wanted.
    pub(crate) measured: bool,
}

/// The drawn picture, with figures.
pub(crate) struct Drawn {
    pub(crate) backend: &'static str,
    pub(crate) adapter: String,
    pub(crate) pixels: Grid<[u8; 3]>,
    /// `None` where a backend does not have them without being asked, and was not asked.
    pub(crate) aovs: Option<Aovs>,
    pub(crate) triangles: usize,
    pub(crate) build_ms: f64,
    pub(crate) times: Times,
}

/// Times of the frames, milliseconds.
pub(crate) struct Times {
    /// By the device's own clock, where it has one.
    pub(crate) gpu: Option<Vec<f64>>,
    /// By the program's clock.
    pub(crate) wall: Vec<f64>,
}
