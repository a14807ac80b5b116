//! Files of a sweep's results: a self-contained page, figures for programs, and tables in Markdown.

mod csv;
mod findings;
mod format;
mod markdown;
mod markup;
mod material;
mod overview;
mod page;
mod pictures;
mod plot;
mod sentences;
mod tables;

use std::path::Path;

use relievo_map::write_atomic;

use crate::error::LabError;
use crate::sweep::{Results, write_json};

/// Writes the results of a sweep to its folder: `report.html` (self-contained, for any browser), `results.json`, `hits.csv`,
/// `pictures.csv` and `summary.md` (the main tables). Each file is written whole or not at all. The pictures named in the
/// results are read from the folder; the page includes them up to a size of about `page_bytes`.
///
/// The same results give the same bytes.
///
/// # Errors
/// If a file cannot be written, or a picture cannot be read.
pub fn write_report(folder: &Path, results: &Results, page_bytes: usize) -> Result<(), LabError> {
    write_json(&folder.join("results.json"), results)?;
    let write = |name: &str, text: &str| write_atomic(&folder.join(name), |file| file.write_all(text.as_bytes()));
    write("hits.csv", &csv::hits(&results.hits))?;
    write("pictures.csv", &csv::pictures(&results.pictures))?;
    write("summary.md", &markdown::summary(results))?;
    write("report.html", &page::page(folder, results, page_bytes)?)?;
    Ok(())
}
