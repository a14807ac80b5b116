//! The `relievo` binary from outside: what it writes, what it says, how it ends.

mod animate;
mod aov;
mod bad_input;
mod compare;
mod files;
#[cfg(feature = "gpu")]
mod gpu;
mod lab;
mod map;
mod map_folders;
mod map_refusals;
mod reliefs;
mod render;
mod room;
mod talk;
#[cfg(feature = "view")]
mod view;
