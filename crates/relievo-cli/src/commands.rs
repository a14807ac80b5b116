//! The subcommands.

pub(crate) mod compare;
pub(crate) mod completions;
pub(crate) mod map;
pub(crate) mod render;
