//! Techniques with settings: the specification that was asked for, and its resolved form that a sweep measures.

mod named;
mod parse;
mod resolved;
mod spec;

pub use named::NamedTechnique;
pub(crate) use named::{BEVY, EXACT, EXACT_CELLS, TUTORIALS};
pub use parse::TechniqueSpecError;
pub use resolved::ResolvedTechnique;
pub use spec::TechniqueSpec;
