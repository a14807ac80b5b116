//! What the tests share.

#![allow(dead_code, unreachable_pub, clippy::print_stdout, clippy::print_stderr)]

pub mod device;
pub mod picture;
pub mod scene;
pub mod tolerances;
