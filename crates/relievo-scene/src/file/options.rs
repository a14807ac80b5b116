use relievo_map::Limits;

use super::overrides::Override;
use crate::SceneTime;

/// Options for loading a scene.
#[derive(Clone, Debug)]
pub struct LoadOptions {
    /// Changes to the scene file, applied in order.
    pub overrides: Vec<Override>,
    /// Limits of the size of a single image.
    pub limits: Limits,
    /// Texels per side of generated materials (`from = "make:…"`), at least 1.
    pub make_size: u32,
    /// Time at which the scene is loaded.
    pub time: SceneTime,
}

impl Default for LoadOptions {
    fn default() -> Self {
        Self { overrides: Vec::new(), limits: Limits::default(), make_size: 1024, time: SceneTime::default() }
    }
}
