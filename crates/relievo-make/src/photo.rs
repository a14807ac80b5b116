//! Heights from the light and dark of a photograph.
//!
//! A photograph holds no heights, but hints: joints and cracks are dark, stones are more saturated than mortar, slopes
//! towards the light are bright. [`from_photo`] splits such hints into bands by scale, gives each a signed weight, and
//! sums them; a [`PhotoPreset`] has the weights for a common material.
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
