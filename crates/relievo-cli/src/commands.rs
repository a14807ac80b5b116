//! The subcommands.

pub(crate) mod compare;
pub(crate) mod completions;
pub(crate) mod devices;
pub(crate) mod lab;
pub(crate) mod map;
pub(crate) mod render;
pub(crate) mod tune;
#[cfg_attr(not(feature = "view"), path = "commands/no_view.rs")]
pub(crate) mod view;
