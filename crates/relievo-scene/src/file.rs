//! The scene file: its keys, its reader, and loading what it names.

mod animated_scene;
mod error;
mod heights;
mod instances;
mod keys;
mod load;
mod map_request;
mod maps;
mod options;
mod overrides;
mod read_limited;
mod sections;
mod source;
mod table;
mod track;

pub use animated_scene::AnimatedScene;
pub use error::{SceneError, SourceLocation};
pub use keys::{SCENE_KEYS, SceneKey, scene_keys_markdown};
pub use options::LoadOptions;
pub use overrides::{Override, OverrideError};
