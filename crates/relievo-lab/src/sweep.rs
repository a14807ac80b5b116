//! Sweeps: angle × depth × technique × settings × backend × minification over materials, against the oracle and the truth.

mod figures;
mod file_name;
mod hits;
mod job;
mod options;
mod pictures;
mod runner;
mod store;

pub use figures::{HitRow, Machine, MaterialRow, PictureRow, Results};
pub use options::{PictureOptions, SweepOptions};
pub use runner::{SweepOutcome, SweepProgress, sweep};
pub(crate) use store::write_json;
