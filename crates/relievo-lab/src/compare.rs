//! Techniques side by side: pictures judged against displaced geometry, hits against the f64 oracle.

mod comparison;
mod options;
mod picture_sheet;
mod runner;
mod summary;

pub use comparison::{Comparison, ComparisonEntry};
pub use options::{CompareError, CompareOptions, CompareProgress};
pub use picture_sheet::{HeatMap, check_sheet};
pub use runner::compare;
pub use summary::{EntrySummary, Summary, TruthSummary};
