//! `[[objects]]`.

use std::path::{Path, PathBuf};

use glam::{Affine3A, Mat3A, Vec2, Vec3};

use crate::SHAPE_NAMES;
use crate::angle::sin_cos_degrees;
use crate::file::error::SceneError;
use crate::file::keys::{self, MAX_NUMBER};
use crate::file::table::{Table, list};
use crate::model::FileKind;
use relievo_toml::{Location, did_you_mean, shorten};

/// An object whose mesh is still to be made or read.
pub(in crate::file) struct PendingObject {
    /// Location of the key `mesh`.
    pub(in crate::file) at: Location,
    pub(in crate::file) mesh: MeshSource,
    /// Index of the material that it names.
    pub(in crate::file) material: Option<usize>,
    pub(in crate::file) transform: Affine3A,
    pub(in crate::file) uv_repeat: Vec2,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::file) enum MeshSource {
    Shape(&'static str),
    File(PathBuf),
}

/// Reads all objects; `materials` are the names of the scene's materials.
pub(in crate::file) fn objects(
    root: &Table<'_>,
    materials: &[&str],
    base_dir: &Path,
) -> Result<Vec<PendingObject>, SceneError> {
    let tables = root.tables("objects", keys::OBJECT)?;
    if tables.is_empty() {
        return Err(root.error("objects", "the scene has no [[objects]]; add one, as mesh = \"quad\""));
    }
    tables.iter().map(|table| object(table, materials, base_dir)).collect()
}

fn object(table: &Table<'_>, materials: &[&str], base_dir: &Path) -> Result<PendingObject, SceneError> {
    let mesh = mesh(table, base_dir)?;
    let material = match table.text("material", "the name of a material")? {
        Some(name) => Some(named(table, name, materials)?),
        None if matches!(mesh, MeshSource::File(_)) => None,
        None => match materials.len() {
            1 => Some(0),
            0 => {
                let message = "this object needs a material, and the scene has none; add a [materials.NAME] table";
                return Err(table.error("material", message));
            }
            _ => {
                let names = list(materials.iter().copied());
                return Err(table.error("material", format!("this object needs a material; name one of {names}")));
            }
        },
    };
    let translate = table.vector("translate")?.unwrap_or(Vec3::ZERO);
    let rotate = table.vector("rotate")?.unwrap_or(Vec3::ZERO);
    let sound_scale = |x: f32| (1e-9..=MAX_NUMBER).contains(&x.abs());
    let expected = "a number or 3 numbers, each of magnitude 1e-9 to 1e9";
    let scale = table.number_or_numbers("scale", expected, sound_scale)?.map_or(Vec3::ONE, Vec3::from_array);
    let expected = "a number or 2 numbers above 0";
    let uv_repeat = table.number_or_numbers("uv_repeat", expected, |x| x > 0.0)?.map_or(Vec2::ONE, Vec2::from_array);
    Ok(PendingObject {
        at: table.at("mesh"),
        mesh,
        material,
        transform: transform(translate, rotate, scale),
        uv_repeat,
    })
}

fn mesh(table: &Table<'_>, base_dir: &Path) -> Result<MeshSource, SceneError> {
    let expected = format!("one of {}, or a .glb, .gltf or .obj file", list(SHAPE_NAMES));
    let Some(name) = table.text("mesh", &expected)? else {
        return Err(table.error("mesh", format!("this object needs a mesh: {expected}")));
    };
    if let Some(shape) = SHAPE_NAMES.into_iter().find(|shape| *shape == name) {
        Ok(MeshSource::Shape(shape))
    } else if FileKind::of(Path::new(name)).is_some() {
        Ok(MeshSource::File(base_dir.join(name)))
    } else {
        let near = did_you_mean(name, SHAPE_NAMES);
        Err(table.error("mesh", format!("mesh = \"{}\" is not known; expected {expected}{near}", shorten(name))))
    }
}

fn named(table: &Table<'_>, name: &str, materials: &[&str]) -> Result<usize, SceneError> {
    materials.iter().position(|known| *known == name).ok_or_else(|| {
        let names = if materials.is_empty() { "there are none".to_owned() } else { list(materials.iter().copied()) };
        let near = did_you_mean(name, materials.iter().copied());
        table.error("material", format!("material = \"{}\" is not in the scene ({names}){near}", shorten(name)))
    })
}

/// Returns the transform that scales, then rotates about the scene's X, then Y, then Z axis, then translates. Degrees.
fn transform(translate: Vec3, rotate: Vec3, scale: Vec3) -> Affine3A {
    let [x, y, z] = rotate.to_array().map(sin_cos_degrees);
    let rotation = rotation_z(z) * rotation_y(y) * rotation_x(x);
    Affine3A { matrix3: rotation * Mat3A::from_diagonal(scale), translation: translate.into() }
}

fn rotation_x((s, c): (f32, f32)) -> Mat3A {
    Mat3A::from_cols_array(&[1.0, 0.0, 0.0, 0.0, c, s, 0.0, -s, c])
}

fn rotation_y((s, c): (f32, f32)) -> Mat3A {
    Mat3A::from_cols_array(&[c, 0.0, -s, 0.0, 1.0, 0.0, s, 0.0, c])
}

fn rotation_z((s, c): (f32, f32)) -> Mat3A {
    Mat3A::from_cols_array(&[c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scale_comes_first_then_x_y_and_z_turns_then_the_move() {
        let point = |translate, rotate, scale, p| transform(translate, rotate, scale).transform_point3(p);
        // X turns +Y to +Z, Y turns +Z to +X, Z turns +X to +Y.
        assert_eq!(point(Vec3::ZERO, Vec3::new(90.0, 0.0, 0.0), Vec3::ONE, Vec3::Y), Vec3::Z);
        assert_eq!(point(Vec3::ZERO, Vec3::new(90.0, 90.0, 0.0), Vec3::ONE, Vec3::Y), Vec3::X);
        assert_eq!(point(Vec3::ZERO, Vec3::new(90.0, 90.0, 90.0), Vec3::ONE, Vec3::Y), Vec3::Y);
        let moved = point(Vec3::new(1.0, 2.0, 3.0), Vec3::new(0.0, 0.0, 90.0), Vec3::new(2.0, 1.0, 1.0), Vec3::X);
        assert_eq!(moved, Vec3::new(1.0, 4.0, 3.0));
    }

    #[test]
    fn any_angle_turns_as_a_rotation_matrix_does() {
        let turned = transform(Vec3::ZERO, Vec3::new(30.0, -400.0, 77.0), Vec3::ONE);
        let expected = Mat3A::from_rotation_z(77f32.to_radians())
            * Mat3A::from_rotation_y(-40f32.to_radians())
            * Mat3A::from_rotation_x(30f32.to_radians());
        assert!(turned.matrix3.abs_diff_eq(expected, 1e-6));
    }
}
