use std::borrow::Cow;
use std::collections::BTreeMap;

use crate::error::ComposeError;
use crate::modules::MODULES;
use crate::permutation::Permutation;

/// The beginning of an import; the name of one module follows.
pub(crate) const IMPORT: &str = "//! #import ";

/// Composes shader modules.
///
/// A module is a WGSL text that lists its imports in lines of the form `//! #import name`. Composing a module gives one
/// WGSL text with every imported module once, before its first user. Nothing in the files is changed.
///
/// A few modules are not files: `chosen_height`, `chosen_technique` and `chosen_shadow` name the functions that a
/// [`Permutation`] stands for.
///
/// ```
/// use relievo_shader::{Composer, Permutation};
///
/// let mut composer = Composer::new(&Permutation::default());
/// composer.add("mine", "//! #import march\n@group(0) @binding(0) var relievo_heights: texture_2d<f32>;\n");
/// let wgsl = composer.compose("mine")?;
/// assert!(wgsl.contains("fn relievo_march("));
/// # Ok::<(), relievo_shader::ComposeError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Composer {
    modules: BTreeMap<String, Cow<'static, str>>,
}

impl Composer {
    /// Knows all modules of this crate, with the choices of a permutation.
    #[must_use]
    pub fn new(permutation: &Permutation) -> Self {
        let mut modules: BTreeMap<_, _> =
            MODULES.iter().map(|&(name, source)| (name.to_owned(), Cow::Borrowed(source))).collect();
        for (name, source) in permutation.choices() {
            modules.insert(name.to_owned(), Cow::Owned(source));
        }
        Self { modules }
    }

    /// Adds a module, or replaces the one with this name.
    pub fn add(&mut self, name: impl Into<String>, source: impl Into<Cow<'static, str>>) -> &mut Self {
        self.modules.insert(name.into(), source.into());
        self
    }

    /// Composes the module `name` with everything it imports to one WGSL text.
    ///
    /// # Errors
    /// If a module is missing, imports go round in a circle, or a line is an import by half.
    pub fn compose(&self, name: &str) -> Result<String, ComposeError> {
        let mut text = String::new();
        for (name, source) in self.ordered(name)? {
            text.push_str("// ==== ");
            text.push_str(name);
            text.push_str(".wgsl\n");
            text.push_str(source);
            text.push('\n');
        }
        Ok(text)
    }

    /// Lists the module `name` and everything it imports, each once and before its first user: names and texts.
    pub(crate) fn ordered<'a>(&'a self, name: &str) -> Result<Vec<(&'a str, &'a str)>, ComposeError> {
        let Some((name, source)) = self.modules.get_key_value(name) else {
            return Err(ComposeError::NoSuchModule(name.to_owned()));
        };
        let mut ordered = Vec::new();
        self.append(name, source, &mut Vec::new(), &mut ordered)?;
        Ok(ordered)
    }

    /// Appends a module after everything it imports, depth first. `path` are the modules on the way here.
    fn append<'a>(
        &'a self,
        name: &'a str,
        source: &'a str,
        path: &mut Vec<&'a str>,
        ordered: &mut Vec<(&'a str, &'a str)>,
    ) -> Result<(), ComposeError> {
        path.push(name);
        for (line, content) in source.lines().enumerate() {
            let line = line + 1;
            let Some(import) = import(content) else { continue };
            let import = import.ok_or_else(|| ComposeError::Malformed { module: name.to_owned(), line })?;
            let Some((import, source)) = self.modules.get_key_value(import) else {
                return Err(ComposeError::UnknownImport { module: name.to_owned(), line, name: import.to_owned() });
            };
            if let Some(start) = path.iter().position(|module| module == import) {
                let chain = path[start..].iter().chain([&path[start]]).map(|&module| module.to_owned()).collect();
                return Err(ComposeError::Circle { module: name.to_owned(), line, chain });
            }
            if !ordered.iter().any(|(known, _)| known == import) {
                self.append(import, source, path, ordered)?;
            }
        }
        path.pop();
        ordered.push((name, source));
        Ok(())
    }
}

/// The name a line imports: `None` if it is no import, `Some(None)` if it is a malformed one.
pub(crate) fn import(line: &str) -> Option<Option<&str>> {
    let code = line.trim_start().trim_start_matches(['/', '!', ' ']);
    if !code.starts_with("#import") {
        return None;
    }
    let name = line.strip_prefix(IMPORT).map(str::trim_end);
    Some(name.filter(|name| !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')))
}
