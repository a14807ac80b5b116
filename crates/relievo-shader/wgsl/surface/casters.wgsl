//! What may throw a shadow on a material.
//!
//! Gives CASTERS_NONE, CASTERS_ITSELF, CASTERS_EVERYTHING.
//! Needs nothing.

const CASTERS_NONE: u32 = 0u;
const CASTERS_ITSELF: u32 = 1u;
const CASTERS_EVERYTHING: u32 = 2u;
