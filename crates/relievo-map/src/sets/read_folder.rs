//! All maps of a material, read from its folder.

use std::collections::BTreeMap;
use std::path::Path;

use super::find::find_maps;
use crate::io::{Limits, Loaded, MapError, name_of, read_color, read_height, read_normal, read_packed, to_scalar};
use crate::types::{Channel, Grid, MapSet, ScalarMap};

/// Finds the maps of a material ([`find_maps`]) and reads them all.
///
/// # Errors
/// If none are found, or one that was found cannot be read.
pub fn read_folder(dir: &Path, limits: &Limits) -> Result<Loaded<MapSet>, MapError> {
    let found = find_maps(dir)?;
    let mut set = MapSet::default();
    let mut notes = found.notes;
    if let Some(path) = &found.base_color {
        set.base_color = Some(keep(read_color(path, limits)?, &mut notes));
    }
    if let Some((path, y)) = &found.normal {
        set.normal = Some(keep(read_normal(path, *y, limits)?, &mut notes));
    }
    if let Some(path) = &found.height {
        set.height = Some(keep(read_height(path, found.height_white, limits)?, &mut notes));
    }
    // A packed file is decoded once for all of its maps.
    let mut files: BTreeMap<&Path, Vec<(Channel, &mut Option<ScalarMap>)>> = BTreeMap::new();
    for (source, slot) in
        [(&found.roughness, &mut set.roughness), (&found.metallic, &mut set.metallic), (&found.ao, &mut set.ao)]
    {
        if let Some((path, channel)) = source {
            files.entry(path).or_default().push((*channel, slot));
        }
    }
    for (path, wanted) in files {
        let raster = read_packed(path, limits)?;
        for (channel, slot) in wanted {
            // Only the file itself shows whether smoothness was put there.
            if channel == Channel::Alpha && !raster.has_alpha() {
                notes.push(format!("{}: ignored as roughness: it has no alpha channel.", name_of(path)));
                continue;
            }
            *slot = Some(keep(to_scalar(&name_of(path), &raster, channel)?, &mut notes));
        }
    }
    if found.roughness_is_gloss {
        set.roughness = set.roughness.map(|gloss| inverted(&gloss));
    }
    Ok(Loaded { map: set, notes })
}

/// 1 − each value: gloss to roughness.
fn inverted(map: &ScalarMap) -> ScalarMap {
    let grid: Grid<f32> = map.grid().map(|&v| 1.0 - v);
    ScalarMap::new(grid)
}

/// Returns the map; its notes go to the others, each once.
fn keep<T>(loaded: Loaded<T>, notes: &mut Vec<String>) -> T {
    for note in loaded.notes {
        if !notes.contains(&note) {
            notes.push(note);
        }
    }
    loaded.map
}
