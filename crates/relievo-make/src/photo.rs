//! Heights from the light and dark of a photograph.
//!
//! A photograph does not hold heights. What it holds are hints: joints and cracks are dark, stones are more coloured than
//! mortar, slopes towards the light are bright. [`from_photo`] takes such hints apart by scale, weighs each with a sign,
//! and puts them together again; presets have weights for common materials.
//!
//! ```text
//!  colour ─▶ linear light ─▶ logarithm − its surroundings ─▶ bands × weights ──┐
//!                         └▶ saturation − its surroundings ─▶ bands × weights ─┤
//!                         └▶ shading ─▶ slopes ─▶ Poisson ─────────────────────┴─▶ Σ ─▶ colour picks ─▶ smoothing that keeps
//!                                                                          edges ─▶ levels ─▶ height, normal, AO, roughness
//! ```

mod bands;
mod error;
mod heights;
mod hints;
mod maps;
mod options;
mod preset;
mod statistics;

pub use error::PhotoError;
pub use heights::from_photo;
pub use maps::PhotoMaps;
pub use options::{BANDS, ColorPick, PhotoEdge, PhotoOptions, SideLight};
pub use preset::PhotoPreset;
