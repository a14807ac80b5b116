//! The scene file: its keys, its reader, and loading what it names.

mod error;
mod instances;
mod keys;
mod load;
mod map_request;
mod maps;
mod options;
mod overrides;
mod sections;
mod source;
mod table;

pub use error::{SceneError, SourceLocation};
pub use keys::{SCENE_KEYS, SceneKey, scene_keys_markdown};
pub use options::LoadOptions;
pub use overrides::{Override, OverrideError};
