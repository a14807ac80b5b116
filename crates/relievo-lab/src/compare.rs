//! Techniques side by side: pictures judged against displaced geometry, hits against the same surface in scene space.

mod comparison;
mod options;
mod picture_sheet;
mod runner;
mod summary;
mod truth;

pub use comparison::{Comparison, ComparisonEntry};
pub use options::{CompareError, CompareOptions, CompareProgress};
pub use picture_sheet::{HeatMap, check_sheet};
pub use runner::compare;
pub use summary::{EntrySummary, Summary, TruthSummary};
