use relievo_scene::InvalidScene;
use thiserror::Error;

/// Reason why a scene could not be drawn.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum RenderError {
    /// A displaced grid would fill the memory.
    #[error(
        "object {object} has {triangles} triangles with grid = {grid}; at most {max} can be drawn: choose a smaller grid or a simpler mesh"
    )]
    TooManyTriangles {
        /// Index into the objects of the scene.
        object: usize,
        /// Triangles that it would take.
        triangles: u64,
        /// Vertices per side that were asked for.
        grid: u32,
        /// The limit.
        max: u64,
    },
    /// The scene, put together or changed in code, breaks a promise of `relievo-scene`.
    #[error("the scene cannot be drawn: {0}")]
    Scene(#[from] InvalidScene),
    /// Heights that change could not be made.
    #[error("the heights of a material cannot be made: {0}")]
    UnmadeHeights(String),
    /// No threads could be had.
    #[error("no pool of {threads} threads could be started: {reason}")]
    Threads {
        /// Threads that were asked for.
        threads: usize,
        /// The system's message.
        reason: String,
    },
}
