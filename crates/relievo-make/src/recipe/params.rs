//! Reader of the keys of one table: each with its range; keys that were not read are unknown.

use relievo_toml::{Entry, Node, Value, did_you_mean, shorten};

use super::error::RecipeError;

/// A table that is being read. Each key that is read becomes known.
pub(crate) struct Params<'a> {
    /// Name of the file, for errors.
    file: &'a str,
    /// The table as it is written, for errors.
    label: String,
    pub(crate) line: usize,
    entries: &'a [Entry],
    known: Vec<&'static str>,
}

impl<'a> Params<'a> {
    pub(crate) fn new(file: &'a str, label: String, line: usize, entries: &'a [Entry]) -> Self {
        Self { file, label, line, entries, known: Vec::new() }
    }

    pub(crate) fn get(&mut self, key: &'static str) -> Option<&'a Node> {
        self.known.push(key);
        self.entries.iter().find(|entry| entry.key == key).map(|entry| &entry.node)
    }

    pub(crate) fn error(&self, line: usize, message: impl Into<String>) -> RecipeError {
        RecipeError::new(self.file, line, message.into())
    }

    fn wrong(&self, key: &str, node: &Node, expected: &str) -> RecipeError {
        self.error(
            node.at.line(),
            format!("{key} in {} must be {expected}, found {}", self.label, node.value.describe()),
        )
    }

    /// Reads a number from `min` to `max`.
    pub(crate) fn number(&mut self, key: &'static str, default: f32, min: f32, max: f32) -> Result<f32, RecipeError> {
        let Some(node) = self.get(key) else { return Ok(default) };
        match node.value.number().map(|n| n as f32).filter(|n| (min..=max).contains(n)) {
            Some(number) => Ok(number),
            None => Err(self.wrong(key, node, &format!("a number from {min} to {max}"))),
        }
    }

    /// Reads a whole number from `min` to `max`.
    pub(crate) fn integer(&mut self, key: &'static str, default: u32, min: u32, max: u32) -> Result<u32, RecipeError> {
        let Some(node) = self.get(key) else { return Ok(default) };
        self.whole(key, node, min, max)
    }

    fn whole(&self, key: &str, node: &Node, min: u32, max: u32) -> Result<u32, RecipeError> {
        let number = if let Value::Integer(n) = node.value { u32::try_from(n).ok() } else { None };
        let number = number.filter(|n| (min..=max).contains(n));
        number.ok_or_else(|| self.wrong(key, node, &format!("a whole number from {min} to {max}")))
    }

    /// Reads one whole number for both directions, or a list of two.
    pub(crate) fn two_integers(
        &mut self,
        key: &'static str,
        default: u32,
        min: u32,
        max: u32,
    ) -> Result<[u32; 2], RecipeError> {
        let Some(node) = self.get(key) else { return Ok([default; 2]) };
        match &node.value {
            Value::Array(items) => match items.as_slice() {
                [a, b] => Ok([self.whole(key, a, min, max)?, self.whole(key, b, min, max)?]),
                _ => Err(self.wrong(key, node, "one whole number or a list of two")),
            },
            _ => Ok([self.whole(key, node, min, max)?; 2]),
        }
    }

    /// Reads a list of two numbers from `min` to `max`.
    pub(crate) fn two_numbers(
        &mut self,
        key: &'static str,
        default: [f32; 2],
        min: f32,
        max: f32,
    ) -> Result<[f32; 2], RecipeError> {
        let Some(node) = self.get(key) else { return Ok(default) };
        let expected = format!("a list of two numbers from {min} to {max}");
        let Value::Array(items) = &node.value else { return Err(self.wrong(key, node, &expected)) };
        let numbers: Vec<f32> = items.iter().filter_map(|item| item.value.number()).map(|n| n as f32).collect();
        match numbers.as_slice() {
            &[a, b] if items.len() == 2 && [a, b].iter().all(|n| (min..=max).contains(n)) => Ok([a, b]),
            _ => Err(self.wrong(key, node, &expected)),
        }
    }

    pub(crate) fn text(&mut self, key: &'static str) -> Result<Option<(&'a str, usize)>, RecipeError> {
        match self.get(key) {
            None => Ok(None),
            Some(Node { at, value: Value::String(text) }) => Ok(Some((text, at.line()))),
            Some(node) => Err(self.wrong(key, node, "a text")),
        }
    }

    /// Reads one of several names.
    pub(crate) fn choice<T: Copy>(
        &mut self,
        key: &'static str,
        names: &[(&'static str, T)],
        default: T,
    ) -> Result<T, RecipeError> {
        let Some((text, line)) = self.text(key)? else { return Ok(default) };
        if let Some((_, value)) = names.iter().find(|(name, _)| *name == text) {
            return Ok(*value);
        }
        let known = || names.iter().map(|(name, _)| *name);
        let list = known().collect::<Vec<_>>().join(", ");
        let near = did_you_mean(text, known());
        let message =
            format!("{key} = \"{}\" in {} is not known{near}; expected one of {list}", shorten(text), self.label);
        Err(self.error(line, message))
    }

    /// Reads a list of `count` texts.
    pub(crate) fn texts(
        &mut self,
        key: &'static str,
        count: usize,
    ) -> Result<Option<Vec<(&'a str, usize)>>, RecipeError> {
        let Some(node) = self.get(key) else { return Ok(None) };
        let expected = format!("a list of {count} names of steps");
        let Value::Array(items) = &node.value else { return Err(self.wrong(key, node, &expected)) };
        let texts: Vec<_> = items
            .iter()
            .filter_map(|item| {
                if let Value::String(text) = &item.value { Some((text.as_str(), item.at.line())) } else { None }
            })
            .collect();
        if texts.len() != count || items.len() != count {
            return Err(self.wrong(key, node, &expected));
        }
        Ok(Some(texts))
    }

    pub(crate) fn missing(&self, key: &str, what: &str) -> RecipeError {
        self.error(self.line, format!("{} needs {key}: {what}", self.label))
    }

    /// Refuses keys that were not read.
    pub(crate) fn finish(self) -> Result<(), RecipeError> {
        match self.entries.iter().find(|entry| !self.known.contains(&entry.key.as_str())) {
            None => Ok(()),
            Some(entry) => {
                let near = did_you_mean(&entry.key, self.known.iter().copied());
                let known = if near.is_empty() { format!("; known are {}", self.known.join(", ")) } else { near };
                Err(self.error(
                    entry.node.at.line(),
                    format!("unknown key \"{}\" in {}{known}", shorten(&entry.key), self.label),
                ))
            }
        }
    }
}
