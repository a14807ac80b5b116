//! Actions on input: keys and commands, camera, lights.

pub(crate) mod camera;
pub(crate) mod commands;
pub(crate) mod controls;
pub(crate) mod light;
