//! Measures parallax mapping techniques against ground truth: FLIP, PSNR, hit errors, comparison sheets, sweeps with
//! reports, and tuning.
//!
//! A picture is a [`Grid<[u8; 3]>`](relievo_map::Grid): 8-bit sRGB, row by row from the top left. Pictures to be compared
//! have one size.
//!
//! ```text
//!  scene, techniques ──▶ compare ──▶ pictures, hit errors, costs ──▶ sheet, summary
//!
//!  reference ─┬─▶ flip              perceived difference per pixel ──▶ heat ─┐
//!  test ──────┤                                                              ├─▶ contact_sheet
//!             └─▶ pixel_difference  PSNR, mean, maximum ──▶ lines of text ───┘
//!
//!  TestMaterial, SweepOptions, MarchBackend ──▶ sweep ──▶ Results ──▶ write_report: HTML, JSON, CSV, Markdown
//!  TestMaterial, TuneOptions, MarchBackend ──▶ tune ──▶ TuneOutcome ──▶ new_scene, edit_scene
//! ```
//!
//! Features:
//! - techniques with settings as text: a [`TechniqueSpec`] is what was asked for (`occlusion:8..32`), a
//!   [`ResolvedTechnique`] has all settings;
//! - hits against an oracle in f64, with false skips, false stops and grazing rays told apart;
//! - pictures against displaced geometry, or far away against many samples per pixel;
//! - fetches by kind, iterations, divergence, time per ray on the CPU, and with feature `gpu` on a GPU.
//!
//! Limits: pictures are 8-bit; a sweep times one thread of the CPU; displaced geometry is judged by pictures alone.
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

mod colors;
mod compare;
mod error;
mod material;
mod measure;
mod metric;
mod report;
mod sheet;
mod sweep;
mod technique;
mod tune;

pub use colors::{NOT_A_NUMBER, heat, heat_color};
pub use compare::{
    CompareError, CompareOptions, CompareProgress, Comparison, ComparisonEntry, EntrySummary, HeatMap, Summary,
    TruthSummary, check_sheet, compare,
};
pub use error::LabError;
pub use material::{TestMaterial, TestMaterialError, corpus, corpus_description, corpus_names};
#[cfg(feature = "gpu")]
pub use measure::GpuMarchBackend;
pub use measure::MarchBackend;
pub use metric::{
    DEFAULT_PIXELS_PER_DEGREE, Flip, FlipError, HitEvaluator, Percentiles, PixelDifference, PixelHitErrors,
    RayHitErrors, SizeMismatch, flip, pixel_difference, pixels_per_degree,
};
pub use report::write_report;
pub use sheet::{SheetError, Tile, contact_sheet};
pub use sweep::{
    HitRow, Machine, MaterialRow, PictureOptions, PictureRow, Results, SweepOptions, SweepOutcome, SweepProgress, sweep,
};
pub use technique::{NamedTechnique, ResolvedTechnique, TechniqueSpec, TechniqueSpecError};
pub use tune::{
    ErrorUnit, SceneEditError, TechniqueCost, Trial, TuneOptions, TuneOutcome, edit_scene, new_scene, tune,
};
