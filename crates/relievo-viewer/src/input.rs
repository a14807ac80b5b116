//! User input, from a window or a script.

pub(crate) mod event;
pub(crate) mod script;
