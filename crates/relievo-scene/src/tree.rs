//! TOML as a tree in which everything knows where it stands, so that errors can say it.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::{Place, SceneError};

/// Where a node comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum At {
    /// A line, from 1.
    Line(usize),
    /// The override with this number.
    Set(usize),
    /// The file as a whole: for what is not there.
    Whole,
}

/// The names that turn an [`At`] into a [`Place`].
#[derive(Clone, Debug, Default)]
pub(crate) struct Source {
    /// The scene's name.
    pub(crate) name: String,
    /// The overrides as `path=value`.
    pub(crate) overrides: Vec<String>,
}

impl Source {
    pub(crate) fn place(&self, at: At) -> Place {
        match at {
            At::Line(line) => Place::Line { file: self.name.clone(), line },
            At::Set(number) => Place::Set(self.overrides.get(number).cloned().unwrap_or_default()),
            At::Whole => Place::File(self.name.clone()),
        }
    }

    pub(crate) fn error(&self, at: At, message: impl Into<String>) -> SceneError {
        SceneError::Invalid { place: self.place(at), message: message.into() }
    }
}

#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub(crate) at: At,
    pub(crate) value: Value,
}

#[derive(Clone, Debug)]
pub(crate) enum Value {
    String(String),
    Integer(i64),
    Float(f64),
    Boolean(bool),
    /// Kept only to be refused by name.
    Datetime,
    Array(Vec<Node>),
    /// In the order of the file.
    Table(Vec<Entry>),
}

#[derive(Clone, Debug)]
pub(crate) struct Entry {
    pub(crate) key: String,
    pub(crate) node: Node,
}

impl Value {
    /// For "found …".
    pub(crate) fn describe(&self) -> String {
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
}

/// A text fit for one line of a message.
pub(crate) fn shorten(text: &str) -> String {
    shorten_to(60, text)
}

fn shorten_to(most: usize, text: &str) -> String {
    let clean: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    if clean.chars().count() <= most { clean } else { clean.chars().take(most - 1).chain(['…']).collect() }
}

/// Parses a document.
pub(crate) fn parse(text: &str, source: &Source) -> Result<Vec<Entry>, SceneError> {
    let lines = Lines::new(text);
    let table = DeTable::parse(text).map_err(|error| {
        let at = error.span().map_or(At::Whole, |span| At::Line(lines.line(span.start)));
        source.error(at, format!("this is not valid TOML: {}", shorten_to(160, error.message())))
    })?;
    entries(table.into_inner(), &|offset| At::Line(lines.line(offset)))
        .map_err(|(at, message)| source.error(at, message))
}

/// Parses a single value, all of it standing at `at`; `None` if it is not TOML.
pub(crate) fn parse_value(text: &str, at: At) -> Option<Result<Value, String>> {
    let value = DeValue::parse(text).ok()?;
    Some(convert(value, &|_| at).map(|node| node.value).map_err(|(_, message)| message))
}

type Refused = (At, String);

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
        let entries = parse(text, &Source::default()).unwrap();
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
        let source = Source { name: "s.toml".to_owned(), overrides: Vec::new() };
        let error = parse("[a]\nb = = 1\n", &source).unwrap_err().to_string();
        assert!(error.starts_with("s.toml:2: this is not valid TOML: "), "{error}");
    }
}
