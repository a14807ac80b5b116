//! Code shared by Relievo's tests and benches: random rays, test maps, altered height fields, and the judge that compares
//! records with the f64 oracle. Not published.
//!
//! Every backend is judged by the same code, so that a slip in one copy cannot hide a wrong hit.

mod corpus;
mod fields;
mod maps;
mod random;
mod rays;

pub use corpus::{Relief, Tally, WRAPS, corpus, many_rays, share};
pub use fields::WithPyramid;
pub use maps::{generated, in_8_bits, noise, spikes};
pub use random::Random;
pub use rays::{ray, tile};
