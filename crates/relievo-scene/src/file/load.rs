//! Loading of a scene at one time.

use std::path::Path;

use super::animated_scene::AnimatedScene;
use super::error::SceneError;
use super::options::LoadOptions;
use crate::Scene;

impl Scene {
    /// Loads a scene file at the time that `options` ask for. The files it names are relative to its folder.
    ///
    /// # Errors
    /// If the file or one that it names cannot be read, or anything in it is wrong: see [`SceneError`].
    pub fn load(path: &Path, options: &LoadOptions) -> Result<Self, SceneError> {
        AnimatedScene::load(path, options)?.at(options.time)
    }

    /// Loads a scene from the text of a scene file. `name` stands for it in errors; the files it names are relative to
    /// `base_dir`.
    ///
    /// # Errors
    /// As [`Scene::load`].
    pub fn parse(text: &str, name: &str, base_dir: &Path, options: &LoadOptions) -> Result<Self, SceneError> {
        AnimatedScene::parse(text, name, base_dir, options)?.at(options.time)
    }
}
