//! `--set path=value`: changes to a scene file before it is read.

use std::fmt;
use std::str::FromStr;

use thiserror::Error;

use super::error::SceneError;
use super::source::Source;
use relievo_toml::{Entry, Location, Node, Value, parse_value};

/// A change to a scene file: `camera.vertical_fov=30`, `lights.0.intensity=2`, `objects.1.mesh=sphere`.
///
/// The path names keys from the outside in; `lights` and `objects`, and the numbers of a list, go by index from 0.
/// A key with a dot in it stands in double quotes. The value is a TOML value; what is not one is taken as text, so that
/// `materials.wall.relief.technique=exact` needs no quotes. Missing tables and keys are made; the index after the last
/// adds a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Override {
    /// Keys and indices, separated by dots.
    pub path: String,
    /// A TOML value or text.
    pub value: String,
}

/// Reason why a text is no [`Override`].
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("\"{text}\" is not of the form path=value, as in camera.vertical_fov=30")]
pub struct OverrideError {
    /// The text.
    pub text: String,
}

impl FromStr for Override {
    type Err = OverrideError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let refused = || OverrideError { text: text.to_owned() };
        let (path, value) = text.split_once('=').ok_or_else(refused)?;
        let (path, value) = (path.trim(), value.trim());
        segments(path).ok_or_else(refused)?;
        Ok(Self { path: path.to_owned(), value: value.to_owned() })
    }
}

impl fmt::Display for Override {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.path, self.value)
    }
}

/// Splits a path into its keys; `None` if one is empty or a quote stays open.
pub(super) fn segments(path: &str) -> Option<Vec<String>> {
    let mut segments = Vec::new();
    let mut rest = path;
    loop {
        let (segment, after) = if let Some(quoted) = rest.strip_prefix('"') {
            quoted.split_once('"')?
        } else {
            rest.split_at(rest.find('.').unwrap_or(rest.len()))
        };
        if segment.trim().is_empty() {
            return None;
        }
        segments.push(segment.trim().to_owned());
        if after.is_empty() {
            return Some(segments);
        }
        rest = after.strip_prefix('.')?;
    }
}

/// Deepest path of an override; scene files are five levels deep.
const MAX_DEPTH: usize = 16;

/// Applies the override with the given number in `source.overrides`.
pub(super) fn apply(
    root: &mut Vec<Entry>,
    change: &Override,
    number: usize,
    source: &Source,
) -> Result<(), SceneError> {
    let at = Location::Set(number);
    let path = segments(&change.path).filter(|path| path.len() <= MAX_DEPTH).ok_or_else(|| {
        source.error(at, "the path has an empty or too many parts; write it as in camera.vertical_fov=30")
    })?;
    let value = match parse_value(&change.value, at) {
        Some(value) => value,
        None => Ok(Value::String(change.value.clone())),
    };
    value.and_then(|value| set_key(root, &path, 0, Node { at, value })).map_err(|message| source.error(at, message))
}

/// Sets the key `path[depth]` and what is below it.
pub(super) fn set_key(table: &mut Vec<Entry>, path: &[String], depth: usize, new: Node) -> Result<(), String> {
    let key = &path[depth];
    let index = table.iter().position(|entry| entry.key == *key).unwrap_or_else(|| {
        let value = if is_list(path, depth) { Value::Array(Vec::new()) } else { Value::Table(Vec::new()) };
        table.push(Entry { key: key.clone(), node: Node { at: new.at, value } });
        table.len() - 1
    });
    set_below(&mut table[index].node, path, depth + 1, new)
}

/// Sets `node` if the path ends before `depth`, else the part of it that the path names.
fn set_below(node: &mut Node, path: &[String], depth: usize, new: Node) -> Result<(), String> {
    let Some(key) = path.get(depth) else {
        *node = new;
        return Ok(());
    };
    let found = node.value.describe();
    let walked = path[..depth].join(".");
    match &mut node.value {
        Value::Table(table) => set_key(table, path, depth, new),
        Value::Array(items) => {
            let count = items.len();
            let grows = depth == 1 && is_list(path, 0);
            let Some(index) = key.parse().ok().filter(|&index: &usize| index < count || (grows && index == count))
            else {
                let range = match count {
                    0 => "it is empty".to_owned(),
                    1 => "0".to_owned(),
                    _ => format!("0 to {}", count - 1),
                };
                let more = if grows { format!(", or {count} to add one") } else { String::new() };
                return Err(format!("\"{walked}\" is a list: \"{key}\" must be an index, {range}{more}"));
            };
            if index == count {
                items.push(Node { at: new.at, value: Value::Table(Vec::new()) });
            }
            set_below(&mut items[index], path, depth + 1, new)
        }
        _ => Err(format!("\"{walked}\" is {found}, there is nothing to set inside")),
    }
}

/// Returns true for the two lists of tables; a material may well be called "0".
fn is_list(path: &[String], depth: usize) -> bool {
    depth == 0 && (path[0] == "lights" || path[0] == "objects")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::source::parse;

    fn applied(text: &str, change: &str) -> Result<Vec<Entry>, String> {
        let source = Source { name: "s.toml".to_owned(), overrides: vec![change.to_owned()] };
        let mut tree = parse(text, &source).unwrap();
        apply(&mut tree, &change.parse().unwrap(), 0, &source).map_err(|error| error.to_string())?;
        Ok(tree)
    }

    #[test]
    fn values_are_toml_or_else_text() {
        let value = |text: &str| {
            let tree = applied("", &format!("a.b={text}")).unwrap();
            let Value::Table(a) = &tree[0].node.value else { panic!() };
            a[0].node.value.describe()
        };
        assert_eq!(value("2"), "2");
        assert_eq!(value("[1, 2]"), "a list of 2");
        assert_eq!(value("offset-limiting"), "the text \"offset-limiting\"");
        assert_eq!(value("\"2\""), "the text \"2\"");
        assert_eq!(value(""), "the text \"\"");
        assert_eq!(value("a=b"), "the text \"a=b\"");
    }

    #[test]
    fn lists_go_by_index_and_grow_by_one() {
        let text = "[[lights]]\nkind = \"point\"\n";
        assert!(applied(text, "lights.0.intensity=2").is_ok());
        assert!(applied(text, "lights.1.kind=spot").is_ok());
        assert_eq!(
            applied(text, "lights.2.kind=spot").unwrap_err(),
            "--set lights.2.kind=spot: \"lights\" is a list: \"2\" must be an index, 0, or 1 to add one"
        );
        assert!(applied("[camera]\nposition = [0, 0, 1]\n", "camera.position.2=4").is_ok());
        assert_eq!(
            applied("[camera]\nnear = 1\n", "camera.near.x=4").unwrap_err(),
            "--set camera.near.x=4: \"camera.near\" is 1, there is nothing to set inside"
        );
    }

    #[test]
    fn a_text_without_a_path_or_value_is_refused() {
        for text in ["camera", "=1", "a..b=1", ".a=1", "\"a=1", ""] {
            assert!(text.parse::<Override>().is_err(), "{text}");
        }
        assert_eq!(segments("materials.\"a.b\".height").unwrap(), ["materials", "a.b", "height"]);
    }
}
