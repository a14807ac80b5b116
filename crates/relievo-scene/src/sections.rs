//! `[image]`, `[camera]`, `[[lights]]` and `[shading]`.

use std::path::Path;

use glam::Vec3;

use crate::error::SceneError;
use crate::keys;
use crate::maps::{Job, Request};
use crate::reader::Table;
use crate::{Camera, ColorSpace, ImageSettings, Light, LightKind, Shading, ShadingModel};

pub(crate) fn image(root: &Table<'_>) -> Result<ImageSettings, SceneError> {
    let mut image = ImageSettings::default();
    let Some(table) = root.table("image", keys::IMAGE, keys::IMAGE)? else { return Ok(image) };
    let max_side = ImageSettings::MAX_SIDE;
    image.width = table.integer("width", 1, max_side)?.unwrap_or(image.width);
    image.height = table.integer("height", 1, max_side)?.unwrap_or(image.height);
    if u64::from(image.width) * u64::from(image.height) > ImageSettings::MAX_PIXELS {
        let max = ImageSettings::MAX_PIXELS;
        let message = format!("{} × {} pixels are too many: at most {max} in all", image.width, image.height);
        return Err(table.error("width", message));
    }
    let unit = |x: f32| (0.0..=1.0).contains(&x);
    image.background = table.numbers("background", "3 numbers from 0 to 1", unit)?.unwrap_or(image.background);
    image.samples = table.integer("samples", 1, ImageSettings::MAX_SAMPLES)?.unwrap_or(image.samples);
    Ok(image)
}

pub(crate) fn camera(root: &Table<'_>) -> Result<Camera, SceneError> {
    let mut camera = Camera::default();
    let Some(table) = root.table("camera", keys::CAMERA, keys::CAMERA)? else { return Ok(camera) };
    camera.position = table.vector("position")?.unwrap_or(camera.position);
    camera.target = table.vector("target")?.unwrap_or(camera.target);
    camera.up = table.vector("up")?.unwrap_or(camera.up);
    let fov = "a number above 0 and below 180 (degrees)";
    camera.vertical_fov = table.number("vertical_fov", fov, |x| x > 0.0 && x < 180.0)?.unwrap_or(camera.vertical_fov);
    camera.near = table.number("near", "a number above 0", |x| x > 0.0)?.unwrap_or(camera.near);
    // f64: small distances between large coordinates, and the squares of small vectors, keep their length.
    let place = ["position", "target"].into_iter().find(|key| table.get(key).is_some()).unwrap_or("position");
    let Some(forward) = (camera.target.as_dvec3() - camera.position.as_dvec3()).try_normalize() else {
        return Err(table.error(place, "[camera] position and target are the same point; move one of them"));
    };
    let Some(up) = camera.up.as_dvec3().try_normalize() else {
        return Err(table.error("up", "up in [camera] has no length; [0, 1, 0] is usual"));
    };
    if forward.cross(up).length() < 1e-6 {
        let place = if table.get("up").is_some() { "up" } else { place };
        let message = "up in [camera] lies along the line of sight; choose another, as [0, 0, -1] when looking down";
        return Err(table.error(place, message));
    }
    Ok(camera)
}

pub(crate) fn lights(root: &Table<'_>, notes: &mut Vec<String>) -> Result<Vec<Light>, SceneError> {
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

pub(crate) fn shading(root: &Table<'_>) -> Result<Shading, SceneError> {
    let mut shading = Shading::default();
    let Some(table) = root.table("shading", keys::SHADING, keys::SHADING)? else { return Ok(shading) };
    let model = |name: &str| match name {
        "blinn-phong" => Some(ShadingModel::BlinnPhong),
        "pbr" => Some(ShadingModel::Pbr),
        _ => None,
    };
    let color_space = |name: &str| match name {
        "linear" => Some(ColorSpace::Linear),
        "display" => Some(ColorSpace::Display),
        _ => None,
    };
    let positive = |x: f32| x >= 0.0;
    shading.model = table.choice("model", &["blinn-phong", "pbr"], model)?.unwrap_or(shading.model);
    shading.color_space =
        table.choice("color_space", &["linear", "display"], color_space)?.unwrap_or(shading.color_space);
    shading.ambient = table.number("ambient", "a number, 0 or more", positive)?.unwrap_or(shading.ambient);
    shading.specular = table.number("specular", "a number, 0 or more", positive)?.unwrap_or(shading.specular);
    shading.shininess = table.number("shininess", "a number above 0", |x| x > 0.0)?.unwrap_or(shading.shininess);
    Ok(shading)
}

/// The environment's file.
pub(crate) fn environment(root: &Table<'_>, base_dir: &Path) -> Result<Option<Job>, SceneError> {
    let Some(table) = root.table("shading", keys::SHADING, keys::SHADING)? else { return Ok(None) };
    let file = table.text("environment", "the name of an image file")?;
    Ok(file.map(|file| Job {
        at: table.at("environment"),
        what: format!("environment in {}", table.label()),
        request: Request::Environment(base_dir.join(file)),
    }))
}
