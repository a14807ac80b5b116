//! Frames on the GPU: drawing, timing, screenshots.

pub(crate) mod picture;
pub(crate) mod screen;
pub(crate) mod screenshot;
pub(crate) mod stage;
pub(crate) mod timer;
pub(crate) mod times;
