//! `[[lights]]`.

use glam::Vec3;

use crate::file::error::SceneError;
use crate::file::keys;
use crate::file::table::Table;
use crate::{Light, LightKind};

pub(in crate::file) fn lights(root: &Table<'_>, notes: &mut Vec<String>) -> Result<Vec<Light>, SceneError> {
    let tables = root.tables("lights", keys::LIGHT)?;
    if tables.is_empty() {
        notes.push("the scene has no [[lights]]: only the ambient part is drawn".to_owned());
    }
    tables.iter().enumerate().map(|(index, table)| light(table, index, notes)).collect()
}

fn light(table: &Table<'_>, index: usize, notes: &mut Vec<String>) -> Result<Light, SceneError> {
    let names = ["point", "directional", "spot"];
    let Some(name) = table.choice("kind", &names, |name| names.into_iter().find(|known| *known == name))? else {
        return Err(table.error("kind", "[[lights]] needs a kind: \"point\", \"directional\" or \"spot\""));
    };
    let position = || {
        table
            .vector("position")?
            .ok_or_else(|| table.error("position", format!("a {name} light needs a position, 3 numbers")))
    };
    let direction = || {
        let direction = table.vector("direction")?.ok_or_else(|| {
            table.error("direction", format!("a {name} light needs a direction, 3 numbers: the way the light travels"))
        })?;
        match direction.as_dvec3().try_normalize() {
            Some(unit) => Ok(unit.as_vec3()),
            None => {
                Err(table.error("direction", "direction in [[lights]] has no length; give the way the light travels"))
            }
        }
    };
    let kind = match name {
        "point" => LightKind::Point { position: position()? },
        "directional" => LightKind::Directional { direction: direction()? },
        _ => spot(table, position()?, direction()?)?,
    };
    let unused: &[&str] = match name {
        "point" => &["direction", "inner_angle", "outer_angle"],
        "directional" => &["position", "inner_angle", "outer_angle"],
        _ => &[],
    };
    for key in unused.iter().filter(|key| table.get(key).is_some()) {
        notes.push(format!("lights.{index}: {key} means nothing for a {name} light"));
    }
    let positive = |x: f32| x >= 0.0;
    Ok(Light {
        kind,
        color: table.numbers("color", "3 numbers, 0 or more", positive)?.unwrap_or([1.0; 3]),
        intensity: table.number("intensity", "a number, 0 or more", positive)?.unwrap_or(1.0),
        radius: table.number("radius", "a number, 0 or more", positive)?.unwrap_or(0.0),
    })
}

fn spot(table: &Table<'_>, position: Vec3, direction: Vec3) -> Result<LightKind, SceneError> {
    let inner = table.number("inner_angle", "a number from 0 to 90 (degrees)", |x| (0.0..=90.0).contains(&x))?;
    let outer = table.number("outer_angle", "a number above 0 and up to 90 (degrees)", |x| x > 0.0 && x <= 90.0)?;
    // Whichever is given alone keeps its value; the other one makes room.
    let (inner_angle, outer_angle) = match (inner, outer) {
        (Some(inner), Some(outer)) => (inner, outer),
        (Some(inner), None) => (inner, if inner < 30.0 { 30.0 } else { (inner + 10.0).min(90.0) }),
        (None, Some(outer)) => (if outer > 20.0 { 20.0 } else { outer * 2.0 / 3.0 }, outer),
        (None, None) => (20.0, 30.0),
    };
    if inner_angle >= outer_angle {
        let message = format!("inner_angle ({inner_angle}) in [[lights]] must be below outer_angle ({outer_angle})");
        return Err(table.error("inner_angle", message));
    }
    Ok(LightKind::Spot { position, direction, inner_angle, outer_angle })
}
