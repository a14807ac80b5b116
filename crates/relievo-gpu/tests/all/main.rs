//! The GPU against the CPU, ray by ray and picture by picture, each with a negative control.

// A test reports its figures.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod common;
mod embedding;
mod live_heights;
mod march;
mod matrix;
mod mist;
mod offscreen;
mod passes;
mod reference;
mod scenes;
mod shells;
mod tiers;
mod tiles;
mod time;
mod truth;
#[path = "../../../relievo-lab/tests/all/tutorials/mod.rs"]
mod tutorials;
mod views;
