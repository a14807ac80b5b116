use relievo_scene::InvalidScene;
use thiserror::Error;

/// Why a scene could not be drawn.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum RenderError {
    /// A displaced grid would fill the memory.
    #[error(
        "object {object} has {triangles} triangles with grid = {grid}; at most {max} can be drawn: choose a smaller grid or a simpler mesh"
    )]
    TooManyTriangles {
        /// Its place in the scene, from 0.
        object: usize,
        /// What it would take.
        triangles: u64,
        /// What was asked for.
        grid: u32,
        /// The limit.
        max: u64,
    },
    /// The scene, put together or changed in code, breaks a promise of `relievo-scene`.
    #[error("the scene cannot be drawn: {0}")]
    Scene(#[from] InvalidScene),
    /// No threads could be had.
    #[error("no pool of {threads} threads could be started: {reason}")]
    Threads {
        /// What was asked for.
        threads: usize,
        /// What the system says.
        reason: String,
    },
}
