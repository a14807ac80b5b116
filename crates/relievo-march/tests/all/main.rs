//! The marches against closed forms, brute force, each other and the oracle.

// A test reports its figures.
#![allow(clippy::print_stdout)]

mod cone;
mod exact;
mod pyramid;
mod robustness;
mod truth;
