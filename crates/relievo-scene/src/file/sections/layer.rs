//! `[[materials.NAME.layers]]` and the other keys of heights that change.

use std::path::Path;

use relievo_make::{HeightLayers, LayerBlend};
use relievo_map::White;
use relievo_toml::Location;

use super::clock::Moment;
use crate::SceneTime;
use crate::file::error::SceneError;
use crate::file::keys;
use crate::file::map_request::{MapRequest, MapSource};
use crate::file::table::Table;

/// A layer whose map is still to be read.
#[derive(Clone)]
pub(in crate::file) struct PendingLayer {
    pub(in crate::file) at: Location,
    pub(in crate::file) repeat: [u32; 2],
    pub(in crate::file) velocity: [f64; 2],
    pub(in crate::file) weight: f32,
}

/// Reads the layers of a material; their maps are requested.
pub(super) fn layers(
    table: &Table<'_>,
    base_dir: &Path,
    requests: &mut Vec<MapRequest>,
) -> Result<(Vec<PendingLayer>, LayerBlend), SceneError> {
    let mut layers = Vec::new();
    for (number, layer) in table.tables("layers", keys::LAYER)?.iter().enumerate() {
        if number == HeightLayers::MAX_LAYERS {
            let most = HeightLayers::MAX_LAYERS;
            return Err(
                layer.error("", format!("{} has more than {most} layers, the most there may be", table.label()))
            );
        }
        let white = layer.one_of("white", &[("high", White::High), ("deep", White::Deep)])?;
        if let Some(file) = layer.text("height", "the name of an image file")? {
            let source = MapSource::Height(base_dir.join(file), white.unwrap_or(White::High));
            let what = format!("height in {}", keys::LAYER);
            requests.push(MapRequest { at: layer.at("height"), what, source, layer: Some(number) });
        } else if white.is_some() {
            return Err(layer.error(
                "white",
                "white says how the layer's file under \"height\" is to be read; name it, or leave white out",
            ));
        }
        layers.push(PendingLayer {
            at: layer.at("height"),
            repeat: whole_repeats(layer)?,
            velocity: velocity(layer, "velocity")?,
            weight: layer.number("weight", "a number, 0 or more", |x| x >= 0.0)?.unwrap_or(1.0),
        });
    }
    let blend = table.one_of("layer_blend", &LayerBlend::ALL)?;
    if blend.is_some() && layers.is_empty() {
        return Err(table
            .error("layer_blend", format!("layer_blend blends the layers of {}, but there are none", table.label())));
    }
    Ok((layers, blend.unwrap_or_default()))
}

fn whole_repeats(layer: &Table<'_>) -> Result<[u32; 2], SceneError> {
    let whole = |x: f32| (1.0..=64.0).contains(&x) && x.fract() == 0.0;
    let repeat = layer.number_or_numbers::<2>("repeat", "a whole number or 2 whole numbers, 1 to 64", whole)?;
    Ok(repeat.map_or([1; 2], |repeat| repeat.map(|x| x as u32)))
}

/// Reads a velocity in repeats per second; none is 0.
pub(super) fn velocity(table: &Table<'_>, key: &str) -> Result<[f64; 2], SceneError> {
    let expected = "2 numbers of magnitude at most 1000 (repeats per second)";
    let rounded = table.numbers::<2>(key, expected, |x| x.abs() <= 1000.0)?;
    let items = match table.get(key).map(|node| &node.value) {
        Some(relievo_toml::Value::Array(items)) => items.as_slice(),
        _ => &[],
    };
    // As written, not rounded to f32: a loop of whole repeats closes.
    let exact = |k: usize| items.get(k).and_then(|item| item.value.number()).unwrap_or(0.0);
    Ok(rounded.map_or([0.0; 2], |_| [exact(0), exact(1)]))
}

/// Says where what moves at this velocity is not back when the loop closes.
pub(super) fn note_on_loop(what: &str, velocity: [f64; 2], moment: Moment, notes: &mut Vec<String>) {
    let Some(length) = moment.length.map(SceneTime::seconds) else { return };
    let is_whole = |x: f64| (x * length - (x * length).round()).abs() < 1e-6;
    if !velocity.into_iter().all(is_whole) {
        let [u, v] = velocity.map(|x| x * length);
        notes.push(format!(
            "{what} moves by {u}, {v} repeats in the scene's loop of {length} s: it jumps where the loop closes, unless they are whole"
        ));
    }
}
