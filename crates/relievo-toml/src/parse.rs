//! Parsing of documents and single values.

use std::error::Error;
use std::fmt;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::names::shorten_to;
use crate::tree::{Entry, Location, Node, Value};

/// Error of [`parse`].
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ParseError {
    /// The location of the error.
    pub location: Location,
    /// The reason, as a sentence without its end.
    pub message: String,
}

impl fmt::Display for ParseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.location {
            Location::Line(line) => write!(f, "line {line}: {}", self.message),
            Location::Set(_) | Location::Whole => f.write_str(&self.message),
        }
    }
}

impl Error for ParseError {}

/// Parses a document.
///
/// # Errors
/// If it is not TOML, or a number is too large.
pub fn parse(text: &str) -> Result<Vec<Entry>, ParseError> {
    let lines = Lines::new(text);
    let table = DeTable::parse(text).map_err(|error| {
        let at = error.span().map_or(Location::Whole, |span| Location::Line(lines.line(span.start)));
        ParseError { location: at, message: format!("this is not valid TOML: {}", shorten_to(160, error.message())) }
    })?;
    entries(table.into_inner(), &|offset| Location::Line(lines.line(offset)))
}

/// Parses a single value, all of it located at `at`; `None` if it is not TOML.
#[must_use]
pub fn parse_value(text: &str, at: Location) -> Option<Result<Value, String>> {
    let value = DeValue::parse(text).ok()?;
    Some(convert(value, &|_| at).map(|node| node.value).map_err(|error| error.message))
}

/// Converts a table, in the order of the file.
fn entries(table: DeTable<'_>, at: &dyn Fn(usize) -> Location) -> Result<Vec<Entry>, ParseError> {
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

/// Converts a value and all in it.
fn convert(value: Spanned<DeValue<'_>>, at: &dyn Fn(usize) -> Location) -> Result<Node, ParseError> {
    let location = at(value.span().start);
    let refuse = |message: String| Err(ParseError { location, message });
    let value = match value.into_inner() {
        DeValue::String(text) => Value::String(text.into_owned()),
        DeValue::Integer(number) => match i64::from_str_radix(number.as_str(), number.radix()) {
            Ok(number) => Value::Integer(number),
            Err(_) => return refuse(format!("the number {number} is too large")),
        },
        DeValue::Float(number) => match number.as_str().parse() {
            Ok(number) => Value::Float(number),
            Err(_) => return refuse(format!("the number {number} cannot be read")),
        },
        DeValue::Boolean(value) => Value::Boolean(value),
        DeValue::Datetime(_) => Value::Datetime,
        DeValue::Array(array) => {
            Value::Array(array.into_iter().map(|item| convert(item, at)).collect::<Result<_, _>>()?)
        }
        DeValue::Table(table) => Value::Table(entries(table, at)?),
    };
    Ok(Node { at: location, value })
}

/// Line numbers of byte offsets.
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
        assert_eq!(keys, [("b", Location::Line(2)), ("a", Location::Line(5)), ("c", Location::Line(8))]);
        let Value::Array(tables) = &entries[2].node.value else { panic!() };
        assert_eq!(tables.iter().map(|table| table.at).collect::<Vec<_>>(), [Location::Line(8), Location::Line(9)]);
        let Value::Table(a) = &entries[1].node.value else { panic!() };
        let Value::Table(inner) = &a[0].node.value else { panic!() };
        let Value::Array(items) = &inner[0].node.value else { panic!() };
        assert_eq!(items.iter().map(|item| item.at).collect::<Vec<_>>(), [Location::Line(6), Location::Line(7)]);
    }

    #[test]
    fn broken_toml_names_its_line() {
        let error = parse("[a]\nb = = 1\n").unwrap_err();
        assert_eq!(error.location.line(), 2);
        let message = &error.message;
        assert!(message.starts_with("this is not valid TOML: "), "{message}");
        assert_eq!(parse("[a]\nb = 99999999999999999999\n").unwrap_err().location, Location::Line(2));
    }
}
