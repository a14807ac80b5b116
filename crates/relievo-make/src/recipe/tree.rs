//! A recipe's TOML as a tree in which everything knows its line.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::RecipeError;
use crate::names::shorten;

#[derive(Clone, Debug)]
pub(crate) struct Node {
    /// From 1.
    pub(crate) line: usize,
    pub(crate) value: Value,
}

#[derive(Clone, Debug)]
pub(crate) enum Value {
    Text(String),
    Integer(i64),
    Float(f64),
    Boolean(bool),
    Other,
    List(Vec<Node>),
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
            Self::Text(text) => format!("\"{}\"", shorten(text)),
            Self::Integer(number) => number.to_string(),
            Self::Float(number) => number.to_string(),
            Self::Boolean(value) => value.to_string(),
            Self::Other => "a date or time".to_owned(),
            Self::List(items) => format!("a list of {}", items.len()),
            Self::Table(_) => "a table".to_owned(),
        }
    }

    pub(crate) fn number(&self) -> Option<f64> {
        match self {
            Self::Integer(number) => Some(*number as f64),
            Self::Float(number) => Some(*number),
            _ => None,
        }
    }
}

/// The tree of `text`; `name` stands for it in errors.
pub(crate) fn parse(name: &str, text: &str) -> Result<Vec<Entry>, RecipeError> {
    let starts: Vec<usize> = std::iter::once(0).chain(text.match_indices('\n').map(|(i, _)| i + 1)).collect();
    let line = |offset: usize| starts.partition_point(|&start| start <= offset);
    let table = DeTable::parse(text).map_err(|error| {
        let at = error.span().map_or(0, |span| line(span.start));
        RecipeError::new(name, at, format!("this is not valid TOML: {}", shorten(error.message())))
    })?;
    entries(table.into_inner(), &line).map_err(|(at, message)| RecipeError::new(name, at, message))
}

fn entries(table: DeTable<'_>, line: &dyn Fn(usize) -> usize) -> Result<Vec<Entry>, (usize, String)> {
    let mut pairs: Vec<_> = table.into_iter().collect();
    // The parser's map is sorted by name; the order should be the file's.
    pairs.sort_by_key(|(key, _)| key.span().start);
    pairs
        .into_iter()
        .map(|(key, value)| {
            let start = key.span().start;
            // A table's own span may be that of a sub-table's header: the key is where the reader looks.
            let node = Node { line: line(start), ..convert(value, line)? };
            Ok(Entry { key: key.into_inner().into_owned(), node })
        })
        .collect()
}

fn convert(value: Spanned<DeValue<'_>>, line: &dyn Fn(usize) -> usize) -> Result<Node, (usize, String)> {
    let at = line(value.span().start);
    let value = match value.into_inner() {
        DeValue::String(text) => Value::Text(text.into_owned()),
        DeValue::Integer(number) => match i64::from_str_radix(number.as_str(), number.radix()) {
            Ok(number) => Value::Integer(number),
            Err(_) => return Err((at, format!("the number {number} is too large"))),
        },
        DeValue::Float(number) => match number.as_str().parse() {
            Ok(number) => Value::Float(number),
            Err(_) => return Err((at, format!("the number {number} cannot be read"))),
        },
        DeValue::Boolean(value) => Value::Boolean(value),
        DeValue::Datetime(_) => Value::Other,
        DeValue::Array(items) => {
            Value::List(items.into_iter().map(|item| convert(item, line)).collect::<Result<_, _>>()?)
        }
        DeValue::Table(table) => Value::Table(entries(table, line)?),
    };
    Ok(Node { line: at, value })
}

/// `changes` laid over `base`: tables are merged, everything else is replaced. A step whose `op` changes keeps nothing.
pub(crate) fn merged(base: Vec<Entry>, changes: Vec<Entry>) -> Vec<Entry> {
    let mut all = base;
    for change in changes {
        let Some(old) = all.iter_mut().find(|entry| entry.key == change.key) else {
            all.push(change);
            continue;
        };
        old.node = match (std::mem::replace(&mut old.node.value, Value::Other), change.node.value) {
            (Value::Table(old), Value::Table(new)) if !new.iter().any(|entry| entry.key == "op") => {
                Node { line: change.node.line, value: Value::Table(merged(old, new)) }
            }
            (_, new) => Node { line: change.node.line, value: new },
        };
    }
    all
}

/// Marks everything as standing at `line`: what comes from another recipe stands where that is named.
pub(crate) fn stand_at(entries: &mut [Entry], line: usize) {
    for entry in entries {
        stand(&mut entry.node, line);
    }
}

fn stand(node: &mut Node, line: usize) {
    node.line = line;
    match &mut node.value {
        Value::List(items) => items.iter_mut().for_each(|item| stand(item, line)),
        Value::Table(entries) => stand_at(entries, line),
        _ => {}
    }
}
