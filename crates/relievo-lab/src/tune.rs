//! Tuning: the cheapest technique that keeps an error, written into a scene.

mod options;
mod outcome;
mod scene_file;
mod search;

pub use options::{ErrorUnit, TechniqueCost, TuneOptions};
pub use outcome::{Trial, TuneOutcome};
pub use scene_file::{SceneEditError, edit_scene, new_scene};
pub use search::tune;
