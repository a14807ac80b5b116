//! The modules with naga_oil's import syntax, for engines that compose shaders with it, such as Bevy.

use std::collections::{BTreeMap, BTreeSet};

use crate::composer::import;
use crate::error::ComposeError;
use crate::permutation::Permutation;
use crate::source::{RELIEF, relief_composer};

/// A module for naga_oil's composer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NagaOilModule {
    /// Path that it is imported by, as in `relievo::march`.
    pub import_path: String,
    /// WGSL with `#define_import_path` and `#import` lines.
    pub source: String,
}

/// Gives the modules behind `relievo_march`, `relievo_shadow` and `relievo_ray_from_axes` for naga_oil, each after those it
/// imports, so that they can be added in this order. `relievo::textures` declares [`Permutation::textures`] in this bind group.
///
/// A shader then says, as an example, `#import relievo::march::relievo_march` and
/// `#import relievo::record::{RelievoRay, RelievoRecord}`.
///
/// # Errors
/// Never with the modules of this crate, as its tests show.
pub fn naga_oil_modules(
    permutation: &Permutation,
    group: u32,
    first_binding: u32,
) -> Result<Vec<NagaOilModule>, ComposeError> {
    let composer = relief_composer(permutation);
    let textures = permutation.texture_declarations(group, first_binding);
    let mut ordered = composer.ordered(RELIEF)?;
    ordered.retain(|(name, _)| *name != RELIEF);
    ordered.insert(0, ("textures", &textures));
    let owners: BTreeMap<&str, &str> =
        ordered.iter().flat_map(|&(module, source)| declared(source).map(move |name| (name, module))).collect();
    Ok(ordered.iter().map(|&(name, source)| module(name, source, &owners)).collect())
}

fn module(name: &str, source: &str, owners: &BTreeMap<&str, &str>) -> NagaOilModule {
    let import_path = format!("relievo::{name}");
    let mut imports = BTreeMap::<&str, BTreeSet<&str>>::new();
    for used in identifiers(source) {
        if let Some(&owner) = owners.get(used).filter(|owner| **owner != name) {
            imports.entry(owner).or_default().insert(used);
        }
    }
    let mut text = format!("#define_import_path {import_path}\n");
    for (owner, names) in imports {
        let names: Vec<&str> = names.into_iter().collect();
        text.push_str(&format!("#import relievo::{owner}::{{{}}}\n", names.join(", ")));
    }
    for line in source.lines().filter(|line| import(line).is_none()) {
        text.push_str(line);
        text.push('\n');
    }
    NagaOilModule { import_path, source: text }
}

/// Names that a module declares at its top level.
fn declared(source: &str) -> impl Iterator<Item = &str> {
    source.lines().filter_map(|line| {
        let keyword = line.strip_prefix("fn ").or_else(|| line.strip_prefix("struct "));
        let keyword = keyword.or_else(|| line.strip_prefix("const "));
        // Globals stand after their binding.
        let declaration = keyword.or_else(|| line.strip_prefix('@')?.split_once(" var ").map(|(_, name)| name));
        identifiers(declaration?).next()
    })
}

/// Names in the code of a text, comments left out.
fn identifiers(source: &str) -> impl Iterator<Item = &str> {
    source
        .lines()
        .map(|line| line.split("//").next().unwrap_or_default())
        .flat_map(|line| line.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_')))
        .filter(|word| word.starts_with(|c: char| c.is_ascii_alphabetic()))
}
