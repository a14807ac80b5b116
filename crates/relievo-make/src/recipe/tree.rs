//! A recipe's TOML, and recipes that begin with another one.

use relievo_toml::{Entry, Location, Node, Value};

use super::error::RecipeError;

/// Parses `text`; `name` stands for it in errors.
pub(crate) fn parse(name: &str, text: &str) -> Result<Vec<Entry>, RecipeError> {
    relievo_toml::parse(text).map_err(|error| RecipeError::new(name, error.location.line(), error.message))
}

/// Merges `changes` into `base`: tables are merged, everything else is replaced. A step whose `op` changes keeps nothing.
pub(crate) fn merged(base: Vec<Entry>, changes: Vec<Entry>) -> Vec<Entry> {
    let mut all = base;
    for change in changes {
        let Some(old) = all.iter_mut().find(|entry| entry.key == change.key) else {
            all.push(change);
            continue;
        };
        old.node = match (std::mem::replace(&mut old.node.value, Value::Datetime), change.node.value) {
            (Value::Table(old), Value::Table(new)) if !new.iter().any(|entry| entry.key == "op") => {
                Node { at: change.node.at, value: Value::Table(merged(old, new)) }
            }
            (_, new) => Node { at: change.node.at, value: new },
        };
    }
    all
}

/// Sets the location of everything to `at`: a recipe used as a base is located where it is named.
pub(crate) fn set_location(entries: &mut [Entry], at: Location) {
    for entry in entries {
        set_node_location(&mut entry.node, at);
    }
}

fn set_node_location(node: &mut Node, at: Location) {
    node.at = at;
    match &mut node.value {
        Value::Array(items) => items.iter_mut().for_each(|item| set_node_location(item, at)),
        Value::Table(entries) => set_location(entries, at),
        _ => {}
    }
}
