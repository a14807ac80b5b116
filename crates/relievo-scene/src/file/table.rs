//! A table of the scene file being read: every wrong type, range or name becomes an error at its line.

use glam::Vec3;

use super::error::SceneError;
use super::keys::{MAX_NUMBER, keys_of};
use super::source::Source;
use relievo_toml::{Entry, Location, Node, Value, did_you_mean, shorten};

#[derive(Clone)]
pub(super) struct Table<'a> {
    source: &'a Source,
    label: String,
    at: Location,
    entries: &'a [Entry],
}

impl<'a> Table<'a> {
    /// Opens the table `label`, whose keys are those of `section` in `SCENE_KEYS`; any other key is an error.
    pub(super) fn new(
        source: &'a Source,
        section: &'static str,
        label: &str,
        at: Location,
        entries: &'a [Entry],
    ) -> Result<Self, SceneError> {
        let table = Self { source, label: label.to_owned(), at, entries };
        match entries.iter().find(|entry| !keys_of(section).any(|key| key == entry.key)) {
            None => Ok(table),
            Some(entry) => {
                let near = did_you_mean(&entry.key, keys_of(section));
                let known = if near.is_empty() { format!("; known are {}", list(keys_of(section))) } else { near };
                let message = format!("unknown key \"{}\" in {label}{known}", shorten(&entry.key));
                Err(source.error(entry.node.at, message))
            }
        }
    }

    pub(super) fn label(&self) -> &str {
        &self.label
    }

    /// Returns the location of the key, or of the table if the key is missing.
    pub(super) fn at(&self, key: &str) -> Location {
        self.get(key).map_or(self.at, |node| node.at)
    }

    pub(super) fn get(&self, key: &str) -> Option<&'a Node> {
        self.entries.iter().find(|entry| entry.key == key).map(|entry| &entry.node)
    }

    pub(super) fn error(&self, key: &str, message: impl Into<String>) -> SceneError {
        self.source.error(self.at(key), message)
    }

    fn wrong(&self, key: &str, node: &Node, expected: &str) -> SceneError {
        self.wrong_as(key, node, expected, &node.value.describe())
    }

    fn wrong_as(&self, key: &str, node: &Node, expected: &str, found: &str) -> SceneError {
        self.source.error(node.at, format!("{key} in {} must be {expected}, found {found}", self.label))
    }

    /// Reads a finite number of magnitude up to [`MAX_NUMBER`] for which `ok` holds; `expected` says so in words.
    pub(super) fn number(
        &self,
        key: &str,
        expected: &str,
        ok: impl Fn(f32) -> bool,
    ) -> Result<Option<f32>, SceneError> {
        let Some(node) = self.get(key) else { return Ok(None) };
        match number(node).filter(|&x| ok(x)) {
            Some(x) => Ok(Some(x)),
            None => Err(self.wrong(key, node, &format!("{expected}{}", limit(node, ok)))),
        }
    }

    /// Reads a list of exactly `N` such numbers.
    pub(super) fn numbers<const N: usize>(
        &self,
        key: &str,
        expected: &str,
        ok: impl Fn(f32) -> bool,
    ) -> Result<Option<[f32; N]>, SceneError> {
        let Some(node) = self.get(key) else { return Ok(None) };
        let Value::Array(items) = &node.value else { return Err(self.wrong(key, node, expected)) };
        let Ok(items) = <&[Node; N]>::try_from(items.as_slice()) else {
            return Err(self.wrong(key, node, expected));
        };
        let mut numbers = [0.0; N];
        for (slot, item) in numbers.iter_mut().zip(items) {
            *slot = number(item).filter(|&x| ok(x)).ok_or_else(|| {
                let all: Vec<_> = items.iter().map(|item| item.value.describe()).collect();
                let found = format!("{} in [{}]", item.value.describe(), all.join(", "));
                self.wrong_as(key, item, &format!("{expected}{}", limit(item, &ok)), &found)
            })?;
        }
        Ok(Some(numbers))
    }

    /// Reads a point or direction.
    pub(super) fn vector(&self, key: &str) -> Result<Option<Vec3>, SceneError> {
        Ok(self.numbers::<3>(key, "3 finite numbers", |_| true)?.map(Vec3::from_array))
    }

    /// Reads one number for all, or `N` of them.
    pub(super) fn number_or_numbers<const N: usize>(
        &self,
        key: &str,
        expected: &str,
        ok: impl Fn(f32) -> bool,
    ) -> Result<Option<[f32; N]>, SceneError> {
        match self.get(key).map(|node| &node.value) {
            Some(Value::Array(_)) => self.numbers(key, expected, ok),
            _ => Ok(self.number(key, expected, ok)?.map(|x| [x; N])),
        }
    }

    pub(super) fn integer(&self, key: &str, min: u32, max: u32) -> Result<Option<u32>, SceneError> {
        let Some(node) = self.get(key) else { return Ok(None) };
        let value = match node.value {
            Value::Integer(number) => u32::try_from(number).ok(),
            _ => None,
        };
        match value.filter(|number| (min..=max).contains(number)) {
            Some(number) => Ok(Some(number)),
            None => Err(self.wrong(key, node, &format!("a whole number from {min} to {max}"))),
        }
    }

    pub(super) fn boolean(&self, key: &str) -> Result<Option<bool>, SceneError> {
        match self.get(key) {
            None => Ok(None),
            Some(Node { value: Value::Boolean(value), .. }) => Ok(Some(*value)),
            Some(node) => Err(self.wrong(key, node, "true or false")),
        }
    }

    /// Reads a text that is not empty.
    pub(super) fn text(&self, key: &str, expected: &str) -> Result<Option<&'a str>, SceneError> {
        match self.get(key) {
            None => Ok(None),
            Some(Node { value: Value::String(text), .. }) if !text.trim().is_empty() => Ok(Some(text)),
            Some(node) => Err(self.wrong(key, node, expected)),
        }
    }

    /// Reads one of several names.
    pub(super) fn choice<T>(
        &self,
        key: &str,
        names: &[&'static str],
        from_name: impl Fn(&str) -> Option<T>,
    ) -> Result<Option<T>, SceneError> {
        let Some(text) = self.text(key, &format!("one of {}", list(names.iter().copied())))? else { return Ok(None) };
        match from_name(text) {
            Some(value) => Ok(Some(value)),
            None => Err(self.error(
                key,
                format!(
                    "{key} = \"{}\" is not known; expected one of {}{}",
                    shorten(text),
                    list(names.iter().copied()),
                    did_you_mean(text, names.iter().copied())
                ),
            )),
        }
    }

    /// Reads one of several names, each with the value that it stands for.
    pub(super) fn one_of<T: Copy>(&self, key: &str, choices: &[(&'static str, T)]) -> Result<Option<T>, SceneError> {
        let names: Vec<_> = choices.iter().map(|choice| choice.0).collect();
        self.choice(key, &names, |name| choices.iter().find(|choice| choice.0 == name).map(|choice| choice.1))
    }

    /// Opens the table under `key`.
    pub(super) fn table(&self, key: &str, section: &'static str, label: &str) -> Result<Option<Self>, SceneError> {
        match self.get(key) {
            None => Ok(None),
            Some(Node { at, value: Value::Table(entries) }) => {
                Self::new(self.source, section, label, *at, entries).map(Some)
            }
            Some(node) => Err(self.wrong(key, node, &format!("a table, {label}"))),
        }
    }

    /// Opens the tables of the list under `key`.
    pub(super) fn tables(&self, key: &str, section: &'static str) -> Result<Vec<Self>, SceneError> {
        let expected = format!("a list of tables; write {section} with two brackets");
        let Some(node) = self.get(key) else { return Ok(Vec::new()) };
        let Value::Array(items) = &node.value else { return Err(self.wrong(key, node, &expected)) };
        items
            .iter()
            .map(|item| match &item.value {
                Value::Table(entries) => Self::new(self.source, section, section, item.at, entries),
                _ => Err(self.wrong(key, item, &expected)),
            })
            .collect()
    }

    /// Opens the named tables inside the table under `key`: name, table.
    pub(super) fn named_tables(&self, key: &str, section: &'static str) -> Result<Vec<(&'a str, Self)>, SceneError> {
        let expected = format!("a table of tables; write {section}");
        let Some(node) = self.get(key) else { return Ok(Vec::new()) };
        let Value::Table(entries) = &node.value else { return Err(self.wrong(key, node, &expected)) };
        entries
            .iter()
            .map(|Entry { key: name, node }| match &node.value {
                Value::Table(entries) => {
                    let label = format!("[{key}.{}]", shorten(name));
                    Ok((name.as_str(), Self::new(self.source, section, &label, node.at, entries)?))
                }
                _ => Err(self.wrong(name, node, &expected)),
            })
            .collect()
    }
}

fn number(node: &Node) -> Option<f32> {
    node.value.number().map(|x| x as f32).filter(|x| x.abs() <= MAX_NUMBER)
}

/// Completes what an error expects by the limit of all numbers, if that is what refuses this number.
fn limit(node: &Node, ok: impl Fn(f32) -> bool) -> String {
    match node.value.number() {
        Some(x) if x.abs() > f64::from(MAX_NUMBER) && ok(x as f32) => format!(", of magnitude at most {MAX_NUMBER:e}"),
        // Too small for f32.
        Some(x) if x != 0.0 && x as f32 == 0.0 && !ok(0.0) && ok(f32::MIN_POSITIVE.copysign(x as f32)) => {
            format!(", of magnitude at least {:e}", f32::MIN_POSITIVE)
        }
        _ => String::new(),
    }
}

/// Joins names for messages: `a, b, c`.
pub(super) fn list<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    names.into_iter().collect::<Vec<_>>().join(", ")
}
