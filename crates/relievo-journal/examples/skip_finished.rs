//! Measures the texts of a folder, and skips what an earlier run has measured.
//!
//! `cargo run -p relievo-journal --example skip_finished -- FOLDER`, twice.

use std::error::Error;
use std::fs;
use std::path::PathBuf;

use relievo_journal::{Input, Journal, Work};
use serde::Serialize;

#[derive(Serialize)]
struct Options {
    words: bool,
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| ".".to_owned()));
    let mut journal = Journal::open(&folder, "count")?;
    for entry in fs::read_dir(&folder)? {
        let path = entry?.path();
        if path.extension().is_none_or(|extension| extension != "txt" && extension != "md") {
            continue;
        }
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let work = Work::new(env!("CARGO_PKG_VERSION"), &Options { words: true })?.reading(Input::of_file(&path)?);
        if journal.finished(&name, &work).is_some() {
            eprintln!("{name}: done before");
            continue;
        }
        journal.begin(&name)?;
        let output = format!("{name}.count");
        fs::write(folder.join(&output), fs::read_to_string(&path)?.split_whitespace().count().to_string())?;
        journal.finish(&name, work, vec![output])?;
        eprintln!("{name}: counted");
    }
    Ok(())
}
