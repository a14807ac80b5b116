//! `KHR_texture_transform`: textures that are moved, turned and scaled.

use glam::Vec2;
use gltf::json::Value;

use crate::{Mesh, UvTransform};

/// Name of the extension.
pub(super) const NAME: &str = "KHR_texture_transform";

/// Reads the extension of a texture: the transform, and the set of texture coordinates if it names another one. `None` if
/// something in it is no number, too large, or a scale of 0.
pub(super) fn read(json: &Value) -> Option<(UvTransform, Option<u64>)> {
    let number = |value: &Value| value.as_f64().map(|x| x as f32).filter(|x| x.abs() <= Mesh::MAX_COORDINATE);
    let pair = |key: &str, default: Vec2| {
        let Some(value) = json.get(key) else { return Some(default) };
        let numbers: Vec<f32> = value.as_array()?.iter().map(number).collect::<Option<_>>()?;
        <[f32; 2]>::try_from(numbers).ok().map(Vec2::from_array)
    };
    let rotation = json.get("rotation").map_or(Some(0.0), number)?;
    let scale = pair("scale", Vec2::ONE)?;
    let transform = UvTransform { offset: pair("offset", Vec2::ZERO)?, rotate: degrees(rotation), scale };
    let tex_coord = json.get("texCoord").and_then(Value::as_u64);
    (scale.abs().min_element() >= 1.0 / Mesh::MAX_COORDINATE).then_some((transform, tex_coord))
}

/// Converts radians to degrees; what f32 cannot tell from a whole number of them becomes one, so that quarter turns are exact.
fn degrees(radians: f32) -> f32 {
    let degrees = radians.to_degrees();
    let whole = degrees.round();
    if (degrees - whole).abs() <= 4.0 * f32::EPSILON * whole.abs() { whole } else { degrees }
}
