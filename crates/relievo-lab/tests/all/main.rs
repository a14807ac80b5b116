//! The tutorials' pictures, level of detail at a distance, and sweeps by the public API.

// A test reports its figures.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod distant;
mod lod;
mod reference;
mod sweep;
mod tutorials;
