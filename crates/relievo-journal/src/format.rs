//! The journal's file: one JSON object with a version, and the entries by kind and name.

use std::collections::BTreeMap;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use relievo_map::write_atomic;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::JournalError;

/// Version of the format that is written, and the latest that is read.
pub(crate) const VERSION: u32 = 1;

/// The file's content. Kinds stay JSON, since those of others are not ours to understand.
#[derive(Default, Serialize, Deserialize)]
pub(crate) struct JournalFile {
    version: u32,
    pub(crate) kinds: BTreeMap<String, Value>,
    #[serde(flatten)]
    rest: Map<String, Value>,
    /// True if the file has one of the formats that had no version.
    #[serde(skip)]
    pub(crate) is_old: bool,
}

impl JournalFile {
    /// Reads the file; one that is not there, or of an old format, has no entries.
    pub(crate) fn read(path: &Path) -> Result<Self, JournalError> {
        let text = match fs::read(path) {
            Ok(text) => text,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Self::default()),
            Err(source) => return Err(JournalError::Unreadable { path: path.to_owned(), source }),
        };
        let not_a_journal = |reason: String| JournalError::NotAJournal { path: path.to_owned(), reason };
        let value: Value = serde_json::from_slice(&text).map_err(|error| not_a_journal(error.to_string()))?;
        let Value::Object(object) = &value else {
            return Err(not_a_journal("it holds no JSON object".to_owned()));
        };
        match object.get("version").and_then(Value::as_u64) {
            Some(version) if version > u64::from(VERSION) => {
                Err(JournalError::NewerFormat { path: path.to_owned(), version, known: VERSION })
            }
            Some(_) => serde_json::from_value(value).map_err(|error| not_a_journal(error.to_string())),
            None if object.values().all(is_old_entry) => Ok(Self { is_old: true, ..Self::default() }),
            None => Err(not_a_journal("it has no version".to_owned())),
        }
    }

    /// Writes the file, whole or not at all.
    pub(crate) fn write(&mut self, path: &Path) -> Result<(), JournalError> {
        self.version = VERSION;
        let json = serde_json::to_string_pretty(self)?;
        Ok(write_atomic(path, |file| writeln!(file, "{json}"))?)
    }
}

/// True for an entry of the formats before version 1: a key as text (`relievo lab`), or an object with a command in words
/// (`relievo map`).
fn is_old_entry(entry: &Value) -> bool {
    let has = |key: &str| entry.get(key).is_some();
    entry.is_string() || has("command") && has("input") && has("outputs")
}
