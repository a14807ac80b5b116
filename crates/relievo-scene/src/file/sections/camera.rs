//! `[camera]`.

use crate::file::error::SceneError;
use crate::file::keys;
use crate::file::table::Table;
use crate::{Camera, CameraKind};

pub(in crate::file) fn camera(root: &Table<'_>) -> Result<Camera, SceneError> {
    let mut camera = Camera::default();
    let Some(table) = root.table("camera", keys::CAMERA, keys::CAMERA)? else { return Ok(camera) };
    camera.kind = table.one_of("kind", &CameraKind::ALL)?.unwrap_or(camera.kind);
    camera.position = table.vector("position")?.unwrap_or(camera.position);
    camera.target = table.vector("target")?.unwrap_or(camera.target);
    camera.up = table.vector("up")?.unwrap_or(camera.up);
    let fov = "a number above 0 and below 180 (degrees)";
    camera.vertical_fov = table.number("vertical_fov", fov, |x| x > 0.0 && x < 180.0)?.unwrap_or(camera.vertical_fov);
    camera.size = table.number("size", "a number above 0", |x| x > 0.0)?.unwrap_or(camera.size);
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
