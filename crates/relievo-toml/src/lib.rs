//! TOML as a tree in which every key and value knows its line, so that errors can name it; and suggestions for misspelt
//! names.
//!
//! - [`parse`] reads a document into [`Entry`]s, in the order of the file; [`parse_value`] reads a single value.
//! - [`Location`] is the line of a [`Node`], or the change on top of the file that it comes from.
//! - [`did_you_mean`] suggests the nearest known name; [`shorten`] makes a text fit for one line of a message.
//!
//! Dates and times are recognised but not decoded; formatting and comments are not kept.
//!
//! ```
//! use relievo_toml::{Location, Value, parse};
//!
//! let entries = parse("[lamp]\nwatts = 40\n").unwrap();
//! let Value::Table(lamp) = &entries[0].node.value else { panic!() };
//! assert_eq!((lamp[0].key.as_str(), lamp[0].node.at), ("watts", Location::Line(2)));
//! ```

mod names;
mod parse;
mod tree;

pub use names::{did_you_mean, shorten};
pub use parse::{ParseError, parse, parse_value};
pub use tree::{Entry, Location, Node, Value};

/// The examples of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
