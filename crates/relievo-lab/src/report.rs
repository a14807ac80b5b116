//! A sweep's results as files: a page that needs no other file, figures for programs, and tables for a text.

mod csv;
mod findings;
mod html;
mod markdown;
mod material;
mod overview;
mod pictures;
mod plot;
mod tables;

use std::path::Path;

use relievo_map::write_atomic;

use crate::sweep::write_json;
use crate::{LabError, Results};

/// Writes what a sweep came to into its folder: `report.html` (with everything in it, for any browser), `results.json`,
/// `hits.csv`, `pictures.csv` and `summary.md` (the main tables). Each appears whole or not at all. The pictures named in
/// the results are read from the folder; those that would make the page larger than about `page_bytes` are left to it.
///
/// The same results give the same bytes.
///
/// # Errors
/// If a file cannot be written, or a picture not be read.
pub fn write_report(folder: &Path, results: &Results, page_bytes: usize) -> Result<(), LabError> {
    write_json(&folder.join("results.json"), results)?;
    let write = |name: &str, text: &str| write_atomic(&folder.join(name), |file| file.write_all(text.as_bytes()));
    write("hits.csv", &csv::hits(&results.hits))?;
    write("pictures.csv", &csv::pictures(&results.pictures))?;
    write("summary.md", &markdown::summary(results))?;
    write("report.html", &html::page(folder, results, page_bytes)?)?;
    Ok(())
}
