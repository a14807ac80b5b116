//! The scene with the changes made in the window.

pub(crate) mod edits;
pub(crate) mod scene_state;
