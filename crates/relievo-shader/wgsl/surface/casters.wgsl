//! What may throw a shadow on a material.
//!
//! Gives RELIEVO_CASTERS_NONE, RELIEVO_CASTERS_ITSELF, RELIEVO_CASTERS_EVERYTHING.
//! Needs nothing.

const RELIEVO_CASTERS_NONE: u32 = 0u;
const RELIEVO_CASTERS_ITSELF: u32 = 1u;
const RELIEVO_CASTERS_EVERYTHING: u32 = 2u;
