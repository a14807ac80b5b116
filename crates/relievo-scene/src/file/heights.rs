//! Heights of materials that change in the course of time: recipes and layers.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use relievo_make::{HeightLayer, HeightLayers};
use relievo_map::HeightMap;

use super::error::SceneError;
use super::maps::HeightsInLoop;
use super::sections::clock::Moment;
use super::sections::layer::PendingLayer;
use super::sections::material::PendingMaterial;
use super::source::Source;
use crate::{ChangingHeights, SceneTime};

/// Layers that were put together before, by the material's name: those that are the same stay the same for renderers.
#[derive(Debug, Default)]
pub(super) struct KnownLayers(Mutex<HashMap<String, Arc<HeightLayers>>>);

impl KnownLayers {
    fn shared(&self, name: &str, layers: HeightLayers) -> Arc<HeightLayers> {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let is_same = |old: &Arc<HeightLayers>| {
            let ids =
                |layers: &HeightLayers| layers.layers.iter().map(|layer| layer.map.grid().id()).collect::<Vec<_>>();
            ids(old) == ids(&layers)
                && (old.blend, old.size) == (layers.blend, layers.size)
                && old
                    .layers
                    .iter()
                    .zip(&layers.layers)
                    .all(|(a, b)| (a.repeat, a.velocity, a.weight) == (b.repeat, b.velocity, b.weight))
        };
        if let Some(old) = known.get(name).filter(|old| is_same(old)) {
            return Arc::clone(old);
        }
        let layers = Arc::new(layers);
        known.insert(name.to_owned(), Arc::clone(&layers));
        layers
    }
}

/// The heights that were read for a material, beside its maps.
#[derive(Default)]
pub(super) struct ReadHeights {
    pub(super) recipe: Option<HeightsInLoop>,
    /// Maps of layers by their number.
    pub(super) layers: Vec<(usize, HeightMap)>,
}

/// Gives a material the heights of the moment: at once, or, if `later`, those of the beginning, and the rest is the renderer's.
pub(super) fn place(
    pending: &mut PendingMaterial,
    read: ReadHeights,
    moment: Moment,
    later: bool,
    (known, source): (&KnownLayers, &Source),
    notes: &mut Vec<String>,
) -> Result<(), SceneError> {
    let first = read.recipe.as_ref().map(|recipe| recipe.first.clone());
    if let Some(first) = first {
        pending.material.maps.height = Some(first);
    }
    let is_loop = read.recipe.is_some();
    let changing = match read.recipe {
        Some(heights) if pending.layers.is_empty() => {
            let own = SceneTime::from_seconds(f64::from(pending.period.unwrap_or(heights.period)));
            let length = pending.period.map_or(moment.length, |_| None).or(own).unwrap_or_default();
            note_on_period(pending, length, moment, notes);
            Some(ChangingHeights::Recipe {
                recipe: heights.recipe,
                size: heights.size,
                phase: moment.time.phase(length),
            })
        }
        _ if pending.layers.is_empty() => None,
        Some(_) => {
            let message = "layers blend maps that stand still, but the height map is a recipe that changes; give its noise a \
                           warp by phase instead, or leave time_cells out";
            return Err(source.error(pending.layers[0].at, message));
        }
        None => Some(layers(pending, read.layers, moment, (known, source))?),
    };
    let Some(changing) = changing else { return Ok(()) };
    if pending.material.maps.normal.is_some() {
        let name = &pending.material.name;
        notes.push(format!(
            "material \"{name}\": its normal map does not follow the heights that change; without it normals do"
        ));
    }
    let is_made = matches!(changing, ChangingHeights::Recipe { phase: 0.0, .. }) && is_loop;
    let has_map = pending.material.maps.height.is_some();
    if !(is_made || later && has_map) {
        let made = changing.heights().map_err(|error| SceneError::Map {
            location: source.location(pending.height_at),
            what: format!("heights of material \"{}\"", pending.material.name),
            source: Box::new(error),
        })?;
        pending.material.maps.height = Some(made);
    }
    pending.material.heights_are_made = is_made || !later;
    pending.material.changing_heights = Some(changing);
    Ok(())
}

fn layers(
    pending: &PendingMaterial,
    mut maps: Vec<(usize, HeightMap)>,
    moment: Moment,
    (known, source): (&KnownLayers, &Source),
) -> Result<ChangingHeights, SceneError> {
    let own = pending.material.maps.height.as_ref();
    let mut layers = Vec::new();
    for (number, layer) in pending.layers.iter().enumerate() {
        let PendingLayer { at, repeat, velocity, weight } = *layer;
        let read = maps.iter().position(|(of, _)| *of == number).map(|at| maps.swap_remove(at).1);
        let Some(map) = read.or_else(|| own.cloned()) else {
            let message = "this layer has no height map, and neither has its material; name an image file under height";
            return Err(source.error(at, message));
        };
        layers.push(HeightLayer { map, repeat, velocity, weight });
    }
    let largest = |map: &HeightMap| [map.grid().width(), map.grid().height()];
    let size = own.or(layers.first().map(|layer| &layer.map)).map_or([1; 2], largest);
    let size = pending.height_size.map_or(size, |size| [size; 2]);
    let layers = known.shared(&pending.material.name, HeightLayers { layers, blend: pending.blend, size });
    Ok(ChangingHeights::Layers { layers, seconds: moment.time.seconds() })
}

/// Says that a recipe is not back when the scene's loop closes.
fn note_on_period(pending: &PendingMaterial, period: SceneTime, moment: Moment, notes: &mut Vec<String>) {
    if let Some(length) = moment.length.filter(|length| length.phase(period) != 0.0) {
        let name = &pending.material.name;
        notes.push(format!(
            "material \"{name}\": its heights go round in {period}, which is no part of the scene's loop of {length}: they jump where \
             it closes"
        ));
    }
}
