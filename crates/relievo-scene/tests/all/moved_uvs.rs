//! Texture coordinates that a material moves, turns, scales and mirrors.

use std::sync::Arc;

use glam::{Affine3A, Vec2, Vec4};
use relievo_scene::{InvalidScene, Material, Mesh, Object, Scene, SurfaceMesh, UvTransform};

use crate::scene_files::parse;

fn object(mesh: Mesh) -> Object {
    Object { mesh: Arc::new(mesh), material: 0, transform: Affine3A::IDENTITY, uv_repeat: Vec2::new(3.0, 2.0) }
}

fn material(offset: [f32; 2], rotate: f32, scale: [f32; 2]) -> Material {
    let uv = UvTransform { offset: offset.into(), rotate, scale: scale.into() };
    Material { uv, ..Material::default() }
}

/// Uv and tangent of every corner.
fn corners(vertices: &SurfaceMesh) -> impl Iterator<Item = (Vec2, Vec4)> + '_ {
    let vertices_of = |triangle: &[u32; 3]| triangle.map(|i| &vertices.vertices[i as usize]);
    vertices.triangles.iter().flat_map(vertices_of).map(|vertex| (vertex.uv, vertex.tangent))
}

/// The share of corners whose tangents differ, and the largest difference of uvs.
fn apart(a: &SurfaceMesh, b: &SurfaceMesh) -> (f64, f32) {
    let pairs: Vec<_> = corners(a).zip(corners(b)).collect();
    let other = pairs.iter().filter(|((_, a), (_, b))| (*a - *b).abs().max_element() > 2e-3).count();
    let uv = pairs.iter().map(|((a, _), (b, _))| (*a - *b).abs().max_element()).fold(0.0, f32::max);
    (other as f64 / pairs.len() as f64, uv)
}

#[test]
fn tangents_are_those_of_a_mesh_that_was_unwrapped_so() {
    for shape in ["quad", "cube", "sphere", "torus", "cylinder"] {
        let object = object(Mesh::shape(shape).unwrap());
        for (offset, rotate, scale) in [
            ([0.25, -3.0], 0.0, [1.0, 1.0]),
            ([0.0, 0.0], 0.0, [2.0, 0.5]),
            ([1.0, 0.0], 0.0, [-1.0, 1.0]),
            ([0.0, 1.0], 0.0, [2.0, -1.0]),
            ([0.0, 0.0], 180.0, [1.0, 1.0]),
            ([0.0, 0.0], 180.0, [-1.0, 3.0]),
            ([0.0, 1.0], 90.0, [0.5, 0.5]),
            ([0.1, 0.2], 37.0, [1.0, -2.0]),
        ] {
            let material = material(offset, rotate, scale);
            let got = SurfaceMesh::in_scene_space(&object, &material);
            let Mesh { positions, normals, uvs, triangles, .. } = (*object.mesh).clone();
            let uvs = uvs.into_iter().map(|uv| material.uv.apply(uv * object.uv_repeat)).collect();
            let unwrapped = Mesh::with_tangents(positions, normals, uvs, triangles).unwrap();
            let unwrapped = Object { mesh: Arc::new(unwrapped), uv_repeat: Vec2::ONE, ..object.clone() };
            let (other, uv) = apart(&got, &SurfaceMesh::in_scene_space(&unwrapped, &Material::default()));
            // At poles tangents are whatever rounding makes them.
            assert!(other <= 0.02 && uv < 1e-5, "{shape}, {rotate}°, scale {scale:?}: {other} of the tangents, {uv}");
            // The control: those of the mesh itself are others, but where directions stay.
            let (own, _) = apart(&got, &SurfaceMesh::in_scene_space(&object, &Material::default()));
            assert_eq!(own > 0.9, !material.uv.keeps_directions(), "{shape}, {rotate}°, {scale:?}: {own}");
        }
    }
}

#[test]
fn without_a_transform_everything_stays_as_it_is() {
    for shape in ["quad", "sphere", "torus"] {
        let object = object(Mesh::shape(shape).unwrap());
        let mesh = SurfaceMesh::in_scene_space(&object, &Material::default());
        assert!(mesh.vertices.iter().zip(&object.mesh.uvs).all(|(vertex, &uv)| vertex.uv == uv * object.uv_repeat));
        assert!(mesh.vertices.iter().zip(&object.mesh.tangents).all(|(v, t)| (v.tangent - *t).length() < 1e-6));
    }
}

#[test]
fn numbers_at_the_limits_give_finite_meshes() {
    let object = object(Mesh::shape("torus").unwrap());
    for scale in [[1e9, 1e-9], [-1e9, 1e9], [1e-9, 1e-9]] {
        for rotate in [0.0, 45.0, 1e9] {
            let mesh = SurfaceMesh::in_scene_space(&object, &material([1e9, -1e9], rotate, scale));
            assert!(mesh.vertices.iter().all(|v| v.uv.is_finite() && v.tangent.is_finite()));
        }
    }
}

/// A scene with these lines in its material.
fn scene(lines: &str) -> Result<Scene, String> {
    let text = format!("[materials.m]\n{lines}\n[[objects]]\nmesh = \"quad\"\n");
    parse(&text).map_err(|error| error.to_string())
}

#[test]
fn the_keys_arrive_and_wrong_ones_are_refused_at_their_line() {
    let material = scene(
        "uv_offset = [0.25, -1]\nuv_rotate = 90\nuv_scale = [2, -0.5]\nuv_rect = [0, 0.5, 0.5, 1]\ntwo_sided = true\n\
         relief.edge = \"clip\"",
    );
    let material = material.unwrap().materials.remove(0);
    let expected = UvTransform { offset: Vec2::new(0.25, -1.0), rotate: 90.0, scale: Vec2::new(2.0, -0.5) };
    assert_eq!((material.uv, material.uv_rect), (expected, Some([0.0, 0.5, 0.5, 1.0])));
    assert_eq!(material.two_sided, Some(true));
    assert_eq!(scene("uv_scale = -2").unwrap().materials[0].uv.scale, Vec2::splat(-2.0));
    assert!(scene("").unwrap().validate().is_ok());
    for (line, expected) in [
        ("uv_offset = 1", "scene.toml:2: uv_offset in [materials.m] must be 2 finite numbers, found "),
        ("uv_rotate = \"x\"", "scene.toml:2: uv_rotate in [materials.m] must be a number of degrees, found "),
        (
            "uv_scale = 0",
            "scene.toml:2: uv_scale in [materials.m] must be a number or 2 numbers, each of magnitude 1e-9 to 1e9",
        ),
        ("uv_scale = [1, nan]", "scene.toml:2: uv_scale in [materials.m] must be a number or 2 numbers"),
        ("uv_rect = [0, 0, 1]", "scene.toml:2: uv_rect in [materials.m] must be 4 numbers u0, v0, u1, v1"),
        ("uv_rect = [0.5, 0, 0.5, 1]", "scene.toml:2: uv_rect in [materials.m] must be 4 numbers u0, v0, u1, v1"),
        ("two_sided = 1", "scene.toml:2: two_sided in [materials.m] must be true or false, found 1"),
        ("uv_rotation = 1", "scene.toml:2: unknown key \"uv_rotation\" in [materials.m]; did you mean \"uv_rotate\"?"),
    ] {
        let error = scene(line).unwrap_err();
        assert!(error.starts_with(expected), "{error}");
    }
    let noted = scene("uv_rect = [0, 0, 1, 1]").unwrap().notes;
    assert!(noted.iter().any(|note| note.contains("goes on beyond uv_rect")), "{noted:?}");
}

#[test]
fn validate_finds_what_cannot_be_mapped() {
    let refused = |change: fn(&mut Material)| {
        let mut scene = scene("").unwrap();
        change(&mut scene.materials[0]);
        scene.validate().unwrap_err()
    };
    assert!(matches!(refused(|m| m.uv.scale.x = 0.0), InvalidScene::Uv { material: 0, .. }));
    assert!(matches!(refused(|m| m.uv.scale.y = f32::NAN), InvalidScene::Uv { .. }));
    assert!(matches!(refused(|m| m.uv.offset.x = f32::INFINITY), InvalidScene::Uv { .. }));
    assert!(matches!(refused(|m| m.uv.offset.y = f32::NAN), InvalidScene::Uv { .. }));
    assert!(matches!(refused(|m| m.uv.rotate = f32::NAN), InvalidScene::Uv { .. }));
    assert!(matches!(refused(|m| m.uv_rect = Some([0.0, 0.0, 0.0, 1.0])), InvalidScene::UvRect { .. }));
    assert!(matches!(refused(|m| m.uv_rect = Some([0.0, 0.0, f32::INFINITY, 1.0])), InvalidScene::UvRect { .. }));
}

#[test]
fn charts_end_at_the_named_part_or_where_the_moved_mesh_does() {
    let bounds = |material: &Material| {
        let object = Object {
            mesh: Mesh::quad().into(),
            material: 0,
            transform: Affine3A::IDENTITY,
            uv_repeat: Vec2::new(3.0, 2.0),
        };
        let mesh = SurfaceMesh::in_scene_space(&object, material);
        assert_eq!(mesh.charts.len(), 1);
        let bounds = mesh.charts[0].bounds();
        (bounds.min, bounds.max)
    };
    assert_eq!(bounds(&Material::default()), ([0.0; 2], [3.0, 2.0]));
    assert_eq!(bounds(&material([0.5, 0.0], 0.0, [-1.0, 2.0])), ([-2.5, 0.0], [0.5, 4.0]));
    assert_eq!(bounds(&material([0.0, 3.0], 90.0, [1.0, 1.0])), ([0.0, 0.0], [2.0, 3.0]));
    let part = Material { uv_rect: Some([0.5, 0.0, 1.0, 0.5]), ..material([0.0, 0.0], 0.0, [1.0, 1.0]) };
    assert_eq!(bounds(&part), ([0.5, 0.0], [1.0, 0.5]));
}
