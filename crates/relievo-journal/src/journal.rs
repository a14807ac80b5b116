use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::format::{self, JournalFile};
use crate::{Entry, JournalError, Work};

/// The record of finished work of one kind in a folder.
///
/// A piece of work has a name that is unique in its kind. Before it is done [`Journal::begin`] forgets the name's entry, and
/// after it [`Journal::finish`] keeps the new one: what is half done is not finished.
#[derive(Debug)]
pub struct Journal {
    folder: PathBuf,
    kind: String,
    entries: BTreeMap<String, Entry>,
    replaces_old_format: bool,
}

impl Journal {
    /// Name of the file in its folder.
    pub const FILE_NAME: &'static str = "relievo-manifest.json";
    /// Version of the format that is written, and the latest that is read.
    pub const VERSION: u32 = format::VERSION;

    /// Opens the journal of a folder for one kind of work; one that is not there has no entries.
    ///
    /// # Errors
    /// If the file cannot be read, is no journal, or was written by a later version.
    pub fn open(folder: &Path, kind: &str) -> Result<Self, JournalError> {
        let mut journal = Self {
            folder: folder.to_owned(),
            kind: kind.to_owned(),
            entries: BTreeMap::new(),
            replaces_old_format: false,
        };
        let mut file = JournalFile::read(&journal.path())?;
        journal.replaces_old_format = file.is_old;
        journal.entries = journal.take_entries(&mut file)?;
        Ok(journal)
    }

    /// Path of the journal's file.
    #[must_use]
    pub fn path(&self) -> PathBuf {
        self.folder.join(Self::FILE_NAME)
    }

    /// A sentence for the user, if the file has one of the formats without a version: all work is done again.
    #[must_use]
    pub fn note(&self) -> Option<String> {
        self.replaces_old_format.then(|| {
            format!(
                "{}: this manifest was written by an earlier version of Relievo; everything is done again",
                self.path().display()
            )
        })
    }

    /// The entry under this name, if it is of the same work and its outputs are all there.
    #[must_use]
    pub fn finished(&self, name: &str, work: &Work) -> Option<&Entry> {
        let entry = self.entries.get(name).filter(|entry| entry.work.is_same(work))?;
        entry.outputs.iter().all(|file| self.folder.join(file).is_file()).then_some(entry)
    }

    /// Forgets the entry under this name, as its outputs are about to change.
    ///
    /// # Errors
    /// If there was one, and the file cannot be written.
    pub fn begin(&mut self, name: &str) -> Result<(), JournalError> {
        if !self.entries.contains_key(name) {
            return Ok(());
        }
        self.update(|entries| {
            entries.remove(name);
        })
    }

    /// Keeps finished work. Entries of this kind that name one of the same outputs are forgotten: their files are gone.
    ///
    /// `outputs` are files relative to the folder.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn finish(&mut self, name: &str, work: Work, outputs: Vec<String>) -> Result<(), JournalError> {
        self.update(|entries| {
            entries.retain(|_, other| !other.outputs.iter().any(|file| outputs.contains(file)));
            entries.insert(name.to_owned(), Entry { work, outputs });
        })
    }

    /// Changes the entries in the file as it is now: another process may have written it.
    fn update(&mut self, change: impl FnOnce(&mut BTreeMap<String, Entry>)) -> Result<(), JournalError> {
        let path = self.path();
        let mut file = JournalFile::read(&path)?;
        let mut entries = self.take_entries(&mut file)?;
        change(&mut entries);
        file.kinds.insert(self.kind.clone(), serde_json::to_value(&entries)?);
        file.write(&path)?;
        self.entries = entries;
        Ok(())
    }

    /// Takes the entries of this kind out of a file.
    fn take_entries(&self, file: &mut JournalFile) -> Result<BTreeMap<String, Entry>, JournalError> {
        let Some(entries) = file.kinds.remove(&self.kind) else { return Ok(BTreeMap::new()) };
        serde_json::from_value::<BTreeMap<String, Entry>>(entries)
            .map_err(|error| JournalError::NotAJournal { path: self.path(), reason: format!("{}: {error}", self.kind) })
    }
}
