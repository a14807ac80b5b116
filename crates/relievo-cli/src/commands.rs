//! The subcommands.

pub(crate) mod compare;
pub(crate) mod completions;
pub(crate) mod devices;
pub(crate) mod lab;
pub(crate) mod map;
pub(crate) mod render;
pub(crate) mod tune;
#[cfg(feature = "view")]
pub(crate) mod view;
