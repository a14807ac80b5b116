//! TOML as a tree in which everything knows where it stands, so that errors can say it; and what is said of names that were
//! misspelt.
//!
//! ```
//! use relievo_toml::{At, Value, parse};
//!
//! let entries = parse("[lamp]\nwatts = 40\n").unwrap();
//! let Value::Table(lamp) = &entries[0].node.value else { panic!() };
//! assert_eq!((lamp[0].key.as_str(), lamp[0].node.at), ("watts", At::Line(2)));
//! ```

mod names;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use names::shorten_to;
pub use names::{did_you_mean, shorten};

/// Where a node comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum At {
    /// A line, from 1.
    Line(usize),
    /// A change that was made to the file by hand: the one with this number.
    Set(usize),
    /// The file as a whole: for what is not there.
    Whole,
}

impl At {
    /// The line, from 1; 0 for what stands in none.
    #[must_use]
    pub fn line(self) -> usize {
        if let Self::Line(line) = self { line } else { 0 }
    }
}

/// A value, and where it stands.
#[derive(Clone, Debug)]
pub struct Node {
    /// The line of its key, or of the value itself in a list.
    pub at: At,
    /// What stands there.
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
    /// Kept only to be refused by name.
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
    /// What it stands for.
    pub node: Node,
}

impl Value {
    /// For "found …".
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

    /// A number, whole or not.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Integer(number) => Some(*number as f64),
            Self::Float(number) => Some(*number),
            _ => None,
        }
    }
}

/// Why a text has no tree: where, and a sentence.
pub type Refused = (At, String);

/// Parses a document.
///
/// # Errors
/// If it is not TOML, or a number is too large.
pub fn parse(text: &str) -> Result<Vec<Entry>, Refused> {
    let lines = Lines::new(text);
    let table = DeTable::parse(text).map_err(|error| {
        let at = error.span().map_or(At::Whole, |span| At::Line(lines.line(span.start)));
        (at, format!("this is not valid TOML: {}", shorten_to(160, error.message())))
    })?;
    entries(table.into_inner(), &|offset| At::Line(lines.line(offset)))
}

/// Parses a single value, all of it standing at `at`; `None` if it is not TOML.
#[must_use]
pub fn parse_value(text: &str, at: At) -> Option<Result<Value, String>> {
    let value = DeValue::parse(text).ok()?;
    Some(convert(value, &|_| at).map(|node| node.value).map_err(|(_, message)| message))
}

fn entries(table: DeTable<'_>, at: &dyn Fn(usize) -> At) -> Result<Vec<Entry>, Refused> {
    let mut pairs: Vec<_> = table.into_iter().collect();
    // The parser's map is sorted by name; the first error and the materials' order should be the file's.
    pairs.sort_by_key(|(key, _)| key.span().start);
    pairs
        .into_iter()
        .map(|(key, value)| {
            let start = key.span().start;
            let mut node = convert(value, at)?;
            // A table's own span may be that of a sub-table's header: the key is where the reader looks.
            node.at = at(start);
            Ok(Entry { key: key.into_inner().into_owned(), node })
        })
        .collect()
}

fn convert(value: Spanned<DeValue<'_>>, at: &dyn Fn(usize) -> At) -> Result<Node, Refused> {
    let place = at(value.span().start);
    let value = match value.into_inner() {
        DeValue::String(text) => Value::String(text.into_owned()),
        DeValue::Integer(number) => match i64::from_str_radix(number.as_str(), number.radix()) {
            Ok(number) => Value::Integer(number),
            Err(_) => return Err((place, format!("the number {number} is too large"))),
        },
        DeValue::Float(number) => match number.as_str().parse() {
            Ok(number) => Value::Float(number),
            Err(_) => return Err((place, format!("the number {number} cannot be read"))),
        },
        DeValue::Boolean(value) => Value::Boolean(value),
        DeValue::Datetime(_) => Value::Datetime,
        DeValue::Array(array) => {
            Value::Array(array.into_iter().map(|item| convert(item, at)).collect::<Result<_, _>>()?)
        }
        DeValue::Table(table) => Value::Table(entries(table, at)?),
    };
    Ok(Node { at: place, value })
}

/// From byte offsets to line numbers.
struct Lines {
    starts: Vec<usize>,
}

impl Lines {
    fn new(text: &str) -> Self {
        Self { starts: std::iter::once(0).chain(text.match_indices('\n').map(|(i, _)| i + 1)).collect() }
    }

    fn line(&self, offset: usize) -> usize {
        self.starts.partition_point(|&start| start <= offset)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_node_knows_its_line_and_keys_keep_the_order_of_the_file() {
        let text = "# scene\n[b]\nx = 1\n\n[a.inner]\ny = [1,\n 2]\n[[c]]\n[[c]]\nz = 1\n";
        let entries = parse(text).unwrap();
        let keys: Vec<_> = entries.iter().map(|entry| (entry.key.as_str(), entry.node.at)).collect();
        assert_eq!(keys, [("b", At::Line(2)), ("a", At::Line(5)), ("c", At::Line(8))]);
        let Value::Array(tables) = &entries[2].node.value else { panic!() };
        assert_eq!(tables.iter().map(|table| table.at).collect::<Vec<_>>(), [At::Line(8), At::Line(9)]);
        let Value::Table(a) = &entries[1].node.value else { panic!() };
        let Value::Table(inner) = &a[0].node.value else { panic!() };
        let Value::Array(items) = &inner[0].node.value else { panic!() };
        assert_eq!(items.iter().map(|item| item.at).collect::<Vec<_>>(), [At::Line(6), At::Line(7)]);
    }

    #[test]
    fn broken_toml_names_its_line() {
        let (at, message) = parse("[a]\nb = = 1\n").unwrap_err();
        assert_eq!(at.line(), 2);
        assert!(message.starts_with("this is not valid TOML: "), "{message}");
        assert_eq!(parse("[a]\nb = 99999999999999999999\n").unwrap_err().0, At::Line(2));
    }
}
