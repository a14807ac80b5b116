//! Judges techniques against the truth: FLIP, PSNR, hit errors, comparison sheets; sweeps with reports; tuning.
//!
//! A picture here is a [`Grid<[u8; 3]>`](relievo_map::Grid): 8-bit sRGB as a display takes it, row by row from the top
//! left. Two pictures to be compared are equal in size.
//!
//! ```text
//!  scene, techniques ──▶ compare ──▶ pictures, hit errors, costs ──▶ sheet, summary
//!
//!  reference ─┬─▶ flip              what an eye would notice, per pixel ──▶ heat ─┐
//!  test ──────┤                                                                   ├─▶ contact_sheet
//!             └─▶ pixel_difference  what the numbers say ──▶ lines of text ───────┘
//!
//!  TestMaterial, SweepOptions, MarchBackend ──▶ sweep ──▶ Results ──▶ write_report: HTML, JSON, CSV, Markdown
//!  TestMaterial, TuneOptions, MarchBackend ──▶ tune ──▶ Tuned ──▶ new_scene, edit_scene
//! ```
//!
//! ```
//! use relievo_lab::{DEFAULT_PIXELS_PER_DEGREE, Tile, contact_sheet, flip, heat, pixel_difference};
//! use relievo_map::Grid;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let reference = Grid::from_fn(64, 64, |x, _| if x < 32 { [40, 40, 40] } else { [200, 180, 160] });
//! let test = Grid::from_fn(64, 64, |x, _| if x < 34 { [40, 40, 40] } else { [200, 180, 160] });
//!
//! let seen = flip(&reference, &test, DEFAULT_PIXELS_PER_DEGREE)?;
//! let counted = pixel_difference(&reference, &test, 8)?;
//! assert_eq!(counted.over, 2.0 / 64.0);
//!
//! let lines = vec!["shifted edge".into(), format!("FLIP\t{:.3}", seen.mean), format!("PSNR\t{:.1} dB", counted.psnr)];
//! let tiles = [Tile { picture: test, lines }, Tile { picture: heat(&seen.map, 1.0), lines: vec!["where".into()] }];
//! let sheet = contact_sheet("An edge two pixels off", &tiles, None, &[])?;
//! # assert!(sheet.width() > 2 * 64);
//! # Ok(())
//! # }
//! ```

mod candidate;
mod compare;
mod compare_sheet;
mod contender;
mod corpus;
mod flip;
mod heat;
mod percentiles;
mod psnr;
mod report;
mod sheet;
mod size;
mod summary;
mod sweep;
mod test_material;
mod tune;

pub use candidate::{Candidate, CandidateError};
pub use compare::{CompareError, CompareOptions, CompareProgress, Comparison, Entry, HitErrors, compare};
pub use compare_sheet::{HeatMap, check_sheet};
pub use contender::{Contender, ContenderError};
pub use corpus::{corpus, corpus_description, corpus_names};
pub use flip::{DEFAULT_PIXELS_PER_DEGREE, Flip, FlipError, flip, pixels_per_degree};
pub use heat::{NOT_A_NUMBER, heat, heat_color};
pub use percentiles::Percentiles;
pub use psnr::{PixelDifference, pixel_difference};
pub use report::write_report;
pub use sheet::{SheetError, Tile, contact_sheet};
pub use size::SizeMismatch;
pub use summary::{EntrySummary, Summary, TruthSummary};
#[cfg(feature = "gpu")]
pub use sweep::GpuMarchBackend;
pub use sweep::{
    HitEvaluator, HitFigures, HitRow, LabError, Machine, MarchBackend, MaterialRow, PictureOptions, PictureRow,
    Results, SweepOptions, SweepProgress, Swept, sweep,
};
pub use test_material::{TestMaterial, TestMaterialError};
pub use tune::{Cost, ErrorUnit, Trial, TuneOptions, Tuned, Tuning, edit_scene, new_scene, tune};
