//! `[shading]`.

use std::path::Path;

use crate::file::error::SceneError;
use crate::file::keys;
use crate::file::map_request::{MapRequest, MapSource};
use crate::file::table::Table;
use crate::{ColorSpace, Shading, ShadingModel};

pub(in crate::file) fn shading(root: &Table<'_>) -> Result<Shading, SceneError> {
    let mut shading = Shading::default();
    let Some(table) = root.table("shading", keys::SHADING, keys::SHADING)? else { return Ok(shading) };
    let models = [("blinn-phong", ShadingModel::BlinnPhong), ("pbr", ShadingModel::Pbr)];
    let color_spaces = [("linear", ColorSpace::Linear), ("display", ColorSpace::Display)];
    let positive = |x: f32| x >= 0.0;
    shading.model = table.one_of("model", &models)?.unwrap_or(shading.model);
    shading.color_space = table.one_of("color_space", &color_spaces)?.unwrap_or(shading.color_space);
    shading.ambient = table.number("ambient", "a number, 0 or more", positive)?.unwrap_or(shading.ambient);
    shading.specular = table.number("specular", "a number, 0 or more", positive)?.unwrap_or(shading.specular);
    shading.shininess = table.number("shininess", "a number above 0", |x| x > 0.0)?.unwrap_or(shading.shininess);
    Ok(shading)
}

/// Reads the file of the environment map.
pub(in crate::file) fn environment(root: &Table<'_>, base_dir: &Path) -> Result<Option<MapRequest>, SceneError> {
    let Some(table) = root.table("shading", keys::SHADING, keys::SHADING)? else { return Ok(None) };
    let file = table.text("environment", "the name of an image file")?;
    Ok(file.map(|file| MapRequest {
        at: table.at("environment"),
        what: format!("environment in {}", table.label()),
        source: MapSource::Environment(base_dir.join(file)),
        layer: None,
    }))
}
