use anyhow::{Context, Result};
use relievo_map::Grid;
use relievo_scene::{AnimatedScene, Scene, SceneTime};

/// An animation to draw.
pub(crate) struct FilmJob<'a> {
    pub(crate) film: &'a AnimatedScene,
    /// The scene of the first frame.
    pub(crate) first: &'a Scene,
    /// Makes the changes that the command line asks for.
    pub(crate) prepare: &'a (dyn Fn(&mut Scene) + Sync),
    pub(crate) times: &'a [SceneTime],
    /// Name of the scene in errors.
    pub(crate) name: String,
    /// Threads of the CPU.
    pub(crate) threads: usize,
}

impl FilmJob<'_> {
    /// The scene of a frame; for a device that makes heights they are not made here.
    pub(crate) fn scene(&self, frame: usize, heights_later: bool) -> Result<Scene> {
        let time = self.times[frame];
        let scene = if heights_later { self.film.at_without_heights(time) } else { self.film.at(time) };
        let mut scene = scene.with_context(|| format!("at {time}"))?;
        (self.prepare)(&mut scene);
        Ok(scene)
    }
}

/// Takes a finished frame: its number and its pixels. Called from any thread.
pub(crate) type Emit<'a> = &'a (dyn Fn(usize, Grid<[u8; 3]>) -> Result<()> + Sync);
