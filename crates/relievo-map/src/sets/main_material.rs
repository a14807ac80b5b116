//! The main material of a folder that holds files of several.

use std::collections::BTreeMap;

use super::listing::Candidate;
use super::map_slot::{MapSlot, fit};

/// Keeps the material with the most maps, and files of other names only where they fill its gaps: a colour of one
/// wall with the normals of another would be worse than none.
///
/// Notes on the files taken in and left out go to `adopted` and `ignored`.
pub(super) fn keep_main_material(
    candidates: &mut Vec<Candidate>,
    ignored: &mut Vec<String>,
    adopted: &mut Vec<String>,
) {
    let slots = |c: &Candidate| MapSlot::ALL.map(|slot| fit(c.name.role, slot).is_some());
    let or = |a: [bool; 6], b: [bool; 6]| std::array::from_fn(|i| a[i] || b[i]);
    let mut materials: BTreeMap<String, [bool; 6]> = BTreeMap::new();
    for c in candidates.iter().filter(|c| c.is_used()) {
        let filled = materials.entry(c.name.material.clone()).or_default();
        *filled = or(*filled, slots(c));
    }
    let count = |filled: &[bool; 6]| filled.iter().filter(|f| **f).count();
    // Of equals the first by name.
    let Some((main, mut filled)) =
        materials.iter().rev().max_by_key(|(_, f)| count(f)).map(|(name, f)| (name.clone(), *f))
    else {
        return;
    };
    let mut allowed = vec![main.clone()];
    for (name, theirs) in materials {
        if name != main && !(0..6).any(|i| filled[i] && theirs[i]) {
            filled = or(filled, theirs);
            allowed.push(name);
        }
    }
    candidates.retain(|c| {
        let keep = !c.is_used() || allowed.contains(&c.name.material);
        if !keep {
            ignored.push(format!("{}: ignored: it belongs to another material than the other maps.", c.file));
        } else if c.is_used() && c.name.material != main {
            adopted.push(format!("{}: its name differs from the other maps'; taken as the same material.", c.file));
        }
        keep
    });
}
