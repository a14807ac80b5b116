//! `kind = "mist"` and `[materials.NAME.mist]`.

use crate::file::error::SceneError;
use crate::file::keys;
use crate::file::table::Table;
use crate::{Material, Mist, MistError};

/// Reads the medium of a material, if it is one.
pub(super) fn mist(table: &Table<'_>) -> Result<Option<Mist>, SceneError> {
    let is_mist = table.one_of("kind", &[("surface", false), ("mist", true)])?.unwrap_or(false);
    let label = format!("{}.mist]", table.label().trim_end_matches(']'));
    let Some(settings) = table.table("mist", keys::MIST, &label)? else {
        return Ok(is_mist.then(Mist::default));
    };
    if !is_mist {
        let message = format!("{label} is for kind = \"mist\" in {}; add that, or leave the table out", table.label());
        return Err(table.error("mist", message));
    }
    let default = Mist::default();
    Ok(Some(Mist {
        density: settings.number("density", "a number, 0 or more", |x| x >= 0.0)?.unwrap_or(default.density),
        softness: settings
            .number("softness", "a number from 0 to 1", |x| (0.0..=1.0).contains(&x))?
            .unwrap_or(default.softness),
        anisotropy: settings
            .number("anisotropy", "a number above -1 and below 1", |x| x.abs() < 1.0)?
            .unwrap_or(default.anisotropy),
        steps: settings.integer("steps", 1, Mist::MAX_STEPS)?.unwrap_or(default.steps),
    }))
}

/// Checks the relief of mist: what it cannot be is an error at the key that says so.
pub(super) fn check(table: &Table<'_>, relief: &Table<'_>, material: &Material) -> Result<(), SceneError> {
    let Err(error) = material.check_mist() else { return Ok(()) };
    let key = match error {
        MistError::Technique { .. } => "technique",
        MistError::Shadow { .. } => "shadow",
        MistError::Edge { .. } => "edge",
        MistError::LevelOfDetail => "lod",
        // Maps are read later.
        _ => return Ok(()),
    };
    Err(relief.error(key, format!("{} is mist, but {error}", table.label())))
}
