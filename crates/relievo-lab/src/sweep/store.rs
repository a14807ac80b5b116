//! A folder of results, with a journal of the cases that are finished.

use std::fs;
use std::path::{Path, PathBuf};

use relievo_journal::{Journal, Work};
use relievo_map::write_atomic;
use serde::{Deserialize, Serialize};

use super::figures::{HitRow, PictureRow};
use crate::LabError;

/// The kind of the journal's entries.
const KIND: &str = "lab";
const CASES: &str = "cases";
const PICTURES: &str = "pictures";

/// The figures of a case.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct Case {
    pub(crate) hits: Vec<HitRow>,
    pub(crate) pictures: Vec<PictureRow>,
}

/// The folder, with the journal of its cases.
pub(crate) struct Store {
    folder: PathBuf,
    journal: Journal,
}

impl Store {
    /// Opens the folder; makes it, if the one it is in is there.
    pub(crate) fn open(folder: &Path) -> Result<Self, LabError> {
        make_folder(folder)?;
        let journal = Journal::open(folder, KIND)?;
        make_folder(&folder.join(CASES))?;
        make_folder(&folder.join(PICTURES))?;
        Ok(Self { folder: folder.to_owned(), journal })
    }

    /// A sentence for the user about the journal that was found.
    pub(crate) fn note(&self) -> Option<String> {
        self.journal.note()
    }

    /// The figures of a case that was finished as this work, if its files are all there.
    pub(crate) fn finished(&self, name: &str, work: &Work) -> Option<Case> {
        self.journal.finished(name, work)?;
        serde_json::from_str(&fs::read_to_string(self.folder.join(case_file(name))).ok()?).ok()
    }

    /// Forgets a case that is measured again: its pictures are about to change.
    pub(crate) fn begin(&mut self, name: &str) -> Result<(), LabError> {
        Ok(self.journal.begin(name)?)
    }

    /// Keeps the figures of a case: from now on it is finished.
    pub(crate) fn keep(&mut self, name: &str, work: Work, case: &Case) -> Result<(), LabError> {
        let file = case_file(name);
        write_json(&self.folder.join(&file), case)?;
        let pictures = case.pictures.iter().flat_map(|row| [Some(&row.picture), Some(&row.truth), row.hits.as_ref()]);
        // All techniques have one truth.
        let mut outputs: Vec<String> = pictures.flatten().cloned().chain([file]).collect();
        outputs.sort();
        outputs.dedup();
        Ok(self.journal.finish(name, work, outputs)?)
    }

    /// Makes the folder for the pictures of a case. Returns the store's folder, and the beginning of their names in it.
    pub(crate) fn pictures(&self, name: &str) -> Result<(&Path, String), LabError> {
        let prefix = format!("{PICTURES}/{name}/");
        let path = self.folder.join(&prefix);
        fs::create_dir_all(&path).map_err(|source| LabError::Folder { path, doing: "making this folder", source })?;
        Ok((&self.folder, prefix))
    }
}

fn make_folder(path: &Path) -> Result<(), LabError> {
    if path.is_dir() {
        return Ok(());
    }
    fs::create_dir(path).map_err(|source| LabError::Folder {
        path: path.to_owned(),
        doing: "making this folder",
        source,
    })
}

fn case_file(name: &str) -> String {
    format!("{CASES}/{name}.json")
}

/// Writes JSON, whole or not at all.
pub(crate) fn write_json(path: &Path, value: &impl Serialize) -> Result<(), LabError> {
    Ok(write_atomic(path, |file| {
        serde_json::to_writer_pretty(&mut *file, value)?;
        file.write_all(b"\n")
    })?)
}
