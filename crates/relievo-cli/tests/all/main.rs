//! The `relievo` binary from outside: what it writes, what it says, how it ends.

mod aov;
mod bad_input;
mod compare;
mod files;
mod map;
mod render;
mod room;
mod talk;
