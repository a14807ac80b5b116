//! A folder's record of finished work, so that a command that is run again does only what is left.
//!
//! A [`Journal`] is one JSON file in the folder that results go to. It holds an [`Entry`] for each piece of finished
//! [`Work`]: a hash of its serialised options, the inputs that were read, and the files that were written. Several kinds of
//! work share the file; each sees and changes its own entries only, and keeps all others, even those of kinds that only a
//! later version knows.
//!
//! # State and limits
//! - Format [`Journal::VERSION`]. Files of a later format are refused; files of the two formats without a version are
//!   recognised, and all work of theirs is done again.
//! - Files appear whole or not at all. Two processes that write at the same moment may lose an entry of each other: that
//!   work is then done again.
//! - Files are told from each other by size and time of change ([`Input::of_file`]), data in memory by a hash of its
//!   content ([`Input::of_content`]).
//! - Hashes are SipHash-2-4 with 128 bits: fit against accidents, not against forgers.

mod content_hash;
mod error;
mod format;
mod journal;
mod work;

pub use content_hash::{ContentHash, ContentHasher};
pub use error::JournalError;
pub use journal::Journal;
pub use work::{Entry, Input, Stamp, Work};
