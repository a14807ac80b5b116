use std::fs;
use std::path::Path;
use std::time::UNIX_EPOCH;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::{ContentHash, JournalError};

/// A piece of work, described by all that its results depend on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Work {
    /// Version of the program.
    product: String,
    /// Options, for a reader; [`Work::key`] decides.
    options: Value,
    /// Hash of the product's version and the serialised options.
    key: ContentHash,
    inputs: Vec<Input>,
}

/// Something that work reads: a file, or data in memory.
///
/// Every file that a piece of work reads belongs into its inputs. A file is known by size and time of change so far; to know
/// it by its content, [`Input::of_file`] is the one place to change.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Input {
    name: String,
    #[serde(flatten)]
    stamp: Stamp,
}

/// The mark by which an input is told from its later states.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Stamp {
    /// Size and time of change of a file.
    Modified {
        /// Bytes.
        bytes: u64,
        /// Nanoseconds since 1970; 0 where the system does not tell.
        time: u64,
    },
    /// Hash of the content.
    Content(ContentHash),
}

/// Finished work, with the files that it wrote.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    #[serde(flatten)]
    pub(crate) work: Work,
    pub(crate) outputs: Vec<String>,
}

impl Work {
    /// Describes work by the version of the program that does it, and its options.
    ///
    /// `options` are the option structs themselves: a field that is added to them later counts without further doing.
    /// They must serialise in the same order each time (no hash maps). What changes no result is to be skipped.
    ///
    /// # Errors
    /// If the options cannot be serialised as JSON.
    pub fn new(product: &str, options: &impl Serialize) -> Result<Self, JournalError> {
        let text = serde_json::to_string(options)?;
        let key = ContentHash::of(format!("{product}\n{text}").as_bytes());
        Ok(Self { product: product.to_owned(), options: serde_json::from_str(&text)?, key, inputs: Vec::new() })
    }

    /// Adds an input.
    #[must_use]
    pub fn reading(mut self, input: Input) -> Self {
        self.inputs.push(input);
        self
    }

    /// Hash of the product's version and the serialised options.
    #[must_use]
    pub fn key(&self) -> &ContentHash {
        &self.key
    }

    /// True if both ask for the same results.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        self.key == other.key && self.inputs == other.inputs
    }
}

impl Input {
    /// Describes a file by its size and time of change.
    ///
    /// # Errors
    /// If the file is not there.
    pub fn of_file(path: &Path) -> Result<Self, JournalError> {
        let metadata = fs::metadata(path).map_err(|source| JournalError::Input { path: path.to_owned(), source })?;
        let time = metadata.modified().ok().and_then(|time| time.duration_since(UNIX_EPOCH).ok());
        let time = time.map_or(0, |time| time.as_nanos() as u64);
        let stamp = Stamp::Modified { bytes: metadata.len(), time };
        Ok(Self { name: path.to_string_lossy().into_owned(), stamp })
    }

    /// Describes data by its content.
    #[must_use]
    pub fn of_content(name: &str, hash: ContentHash) -> Self {
        Self { name: name.to_owned(), stamp: Stamp::Content(hash) }
    }

    /// The file's path as it was given, or the data's name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The mark by which it is known.
    #[must_use]
    pub fn stamp(&self) -> &Stamp {
        &self.stamp
    }
}

impl Entry {
    /// The work that is finished.
    #[must_use]
    pub fn work(&self) -> &Work {
        &self.work
    }

    /// Files that it wrote, relative to the folder.
    #[must_use]
    pub fn outputs(&self) -> &[String] {
        &self.outputs
    }
}
