//! The names of all built-in materials.

use super::recipes::RECIPES;

/// The materials that code makes; all others are recipes.
pub(super) const CODED: [&str; 2] = ["brick-wall", "toy-box"];

const NAMES: [&str; CODED.len() + RECIPES.len()] = {
    let mut names = [""; CODED.len() + RECIPES.len()];
    let mut k = 0;
    while k < names.len() {
        names[k] = if k < CODED.len() { CODED[k] } else { RECIPES[k - CODED.len()].0 };
        k += 1;
    }
    names
};

/// Returns the names of all built-in materials, as [`make`](crate::make) takes them.
#[must_use]
pub fn names() -> &'static [&'static str] {
    &NAMES
}

/// Returns the known name that is most like `name`, if one is.
pub(super) fn nearest(name: &str) -> Option<&'static str> {
    NAMES
        .into_iter()
        .map(|known| (strsim::jaro_winkler(known, &name.to_lowercase()), known))
        .filter(|&(likeness, _)| likeness > 0.7)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, known)| known)
}
