//! Pictures drawn on the CPU, judged by geometry, by formulas and by truly displaced meshes.

// A test reports its figures.
#![allow(clippy::print_stdout)]

mod aovs;
mod columns;
mod common;
mod displaced;
mod edges;
mod gallery;
mod lamps;
mod lights;
mod lod;
mod meshes;
mod mist;
mod odd;
mod orientation;
mod orthographic;
mod sampling;
mod shadows;
mod threads;
mod time;
mod truth;
mod two_sides;
mod uvs;
