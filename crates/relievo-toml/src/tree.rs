//! The tree: tables, values and their locations.

use crate::names::shorten;

/// The location of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    /// A line, from 1.
    Line(usize),
    /// A change made on top of the file: the one with this number.
    Set(usize),
    /// The file as a whole: for nodes that are missing.
    Whole,
}

impl Location {
    /// Returns the line, from 1; 0 for other locations.
    #[must_use]
    pub fn line(self) -> usize {
        if let Self::Line(line) = self { line } else { 0 }
    }
}

/// A value and its location.
#[derive(Clone, Debug)]
pub struct Node {
    /// The line of its key, or of the value itself in a list.
    pub at: Location,
    /// The value.
    pub value: Value,
}

/// A TOML value.
#[derive(Clone, Debug)]
pub enum Value {
    /// A text.
    String(String),
    /// A whole number.
    Integer(i64),
    /// A number; it may be infinite or NaN.
    Float(f64),
    /// True or false.
    Boolean(bool),
    /// A date or time: kept only to be refused by name.
    Datetime,
    /// A list.
    Array(Vec<Node>),
    /// A table, in the order of the file.
    Table(Vec<Entry>),
}

/// A key and its value.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The key.
    pub key: String,
    /// Its value and location.
    pub node: Node,
}

impl Value {
    /// Describes the value, for messages of the form "found …".
    #[must_use]
    pub fn describe(&self) -> String {
        match self {
            Self::String(text) => format!("the text \"{}\"", shorten(text)),
            Self::Integer(number) => number.to_string(),
            Self::Float(number) if number.is_finite() && number.abs() >= 1e15 => format!("{number:e}"),
            Self::Float(number) if *number != 0.0 && number.abs() < 1e-4 => format!("{number:e}"),
            Self::Float(number) => number.to_string(),
            Self::Boolean(value) => value.to_string(),
            Self::Datetime => "a date or time".to_owned(),
            Self::Array(items) => format!("a list of {}", items.len()),
            Self::Table(_) => "a table".to_owned(),
        }
    }

    /// Returns the number, whole or not.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Integer(number) => Some(*number as f64),
            Self::Float(number) => Some(*number),
            _ => None,
        }
    }
}
