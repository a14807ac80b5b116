//! A folder of results that remembers what is done.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use relievo_map::write_atomic;
use serde::{Deserialize, Serialize};

use super::figures::{HitRow, PictureRow};
use crate::LabError;

const MANIFEST: &str = "relievo-manifest.json";
const CASES: &str = "cases";
const PICTURES: &str = "pictures";

/// The figures of a case.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct Case {
    pub(crate) hits: Vec<HitRow>,
    pub(crate) pictures: Vec<PictureRow>,
}

/// The folder, with the manifest: each case's name and key.
pub(crate) struct Store {
    folder: PathBuf,
    done: BTreeMap<String, String>,
}

impl Store {
    /// Opens the folder; makes it, if the one it is in is there.
    pub(crate) fn open(folder: &Path) -> Result<Self, LabError> {
        for path in [folder, &folder.join(CASES), &folder.join(PICTURES)] {
            if !path.is_dir() {
                fs::create_dir(path).map_err(|source| LabError::Folder {
                    path: path.to_owned(),
                    doing: "making this folder",
                    source,
                })?;
            }
        }
        let manifest = folder.join(MANIFEST);
        let done = match fs::read_to_string(&manifest) {
            Ok(text) => serde_json::from_str(&text)
                .map_err(|error| LabError::Manifest { path: manifest, reason: error.to_string() })?,
            Err(_) => BTreeMap::new(),
        };
        Ok(Self { folder: folder.to_owned(), done })
    }

    /// The figures of a case that was finished with this key, if its files are all there.
    pub(crate) fn finished(&self, name: &str, key: &str) -> Option<Case> {
        if self.done.get(name)? != key {
            return None;
        }
        let case: Case = serde_json::from_str(&fs::read_to_string(self.path(name)).ok()?).ok()?;
        let is_there = |file: &String| self.folder.join(file).is_file();
        let complete =
            |row: &PictureRow| is_there(&row.picture) && is_there(&row.truth) && row.hits.iter().all(is_there);
        if case.pictures.iter().all(complete) { Some(case) } else { None }
    }

    /// Writes the figures of a case and marks it as done.
    pub(crate) fn keep(&mut self, name: &str, key: &str, case: &Case) -> Result<(), LabError> {
        // What is half written is not done.
        if self.done.remove(name).is_some() {
            self.write_manifest()?;
        }
        write_json(&self.path(name), case)?;
        self.done.insert(name.to_owned(), key.to_owned());
        self.write_manifest()
    }

    /// Creates the folder of a case's pictures; returns the results' folder and the prefix of the names.
    pub(crate) fn pictures(&self, name: &str) -> Result<(&Path, String), LabError> {
        let prefix = format!("{PICTURES}/{name}/");
        let path = self.folder.join(&prefix);
        fs::create_dir_all(&path).map_err(|source| LabError::Folder { path, doing: "making this folder", source })?;
        Ok((&self.folder, prefix))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(CASES).join(format!("{name}.json"))
    }

    fn write_manifest(&self) -> Result<(), LabError> {
        write_json(&self.folder.join(MANIFEST), &self.done)
    }
}

/// Writes JSON, whole or not at all.
pub(crate) fn write_json(path: &Path, value: &impl Serialize) -> Result<(), LabError> {
    Ok(write_atomic(path, |file| {
        serde_json::to_writer_pretty(&mut *file, value)?;
        file.write_all(b"\n")
    })?)
}
