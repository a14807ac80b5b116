use std::path::{Path, PathBuf};

use glam::{Vec2, Vec3};
use relievo_map::Limits;
use relievo_scene::{LoadOptions, Model, Scene};
use tempfile::TempDir;

fn file(text: impl AsRef<[u8]>) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.obj");
    std::fs::write(&path, text).unwrap();
    (folder, path)
}

pub(crate) fn load(text: impl AsRef<[u8]>) -> Result<Model, String> {
    let (_folder, path) = file(text);
    Model::load(&path, &Limits::default(), true).map_err(|error| error.message)
}

pub(crate) const SQUARE: &str = "# a square\nmtllib none.mtl\no wall\nv -1 1 0\nv -1 -1 0 1.0\nv 1 -1 0\nv 1 1 0\n\
    vt 0 1\nvt 0 0\nvt 1 0\nvt 1 1 0\nvn 0 0 2\nusemtl x\ns off\nf 1/1/1 2/2/1 3/3/1 4/4/1\n";

#[test]
fn a_square_becomes_two_triangles_with_v_turned_down_and_tangents() {
    let model = load(SQUARE).unwrap();
    let mesh = &model.parts[0].mesh;
    mesh.validate().unwrap();
    assert_eq!((mesh.positions.len(), mesh.triangles.len()), (4, 2));
    for i in 0..4 {
        let Vec3 { x, y, .. } = mesh.positions[i];
        assert_eq!(mesh.uvs[i], Vec2::new(0.5 + 0.5 * x, 0.5 - 0.5 * y));
        assert_eq!(mesh.normals[i], Vec3::Z);
        assert_eq!(mesh.tangents[i], glam::Vec4::new(1.0, 0.0, 0.0, 1.0));
    }
    assert!(model.parts[0].has_uvs);
}

#[test]
fn backward_indices_continued_lines_and_carriage_returns_are_read() {
    let text = "v 0 0 0\r\nv 1 0 0\r\nv 0 \\\r\n1 0\r\nf -3 \\\r\n -2 -1\r\n";
    let model = load(text).unwrap();
    assert_eq!(model.parts[0].mesh.triangles.len(), 1);
    assert!(!model.parts[0].has_uvs);
}

#[test]
fn missing_normals_are_smooth_on_round_things_and_sharp_at_edges() {
    // A cube: every corner keeps three normals.
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
                f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    let mesh = &load(cube).unwrap().parts[0].mesh;
    assert!(mesh.normals.iter().all(|n| n.abs().max_element() == 1.0));
    // Two faces that meet at a blunt angle share the normals of their edge.
    let roof = "v 0 0 0\nv 1 0 0\nv 0 1 0.1\nv 1 1 0.1\nv 0 2 0\nv 1 2 0\nf 1 2 4 3\nf 3 4 6 5\n";
    let mesh = &load(roof).unwrap().parts[0].mesh;
    let ridge: Vec<_> = (0..mesh.positions.len()).filter(|&i| mesh.positions[i].y == 1.0).collect();
    assert!(ridge.iter().all(|&i| mesh.normals[i].abs_diff_eq(Vec3::Z, 1e-6)), "{:?}", mesh.normals);
}

#[test]
fn a_fan_of_very_many_triangles_is_smoothed_in_time() {
    // Every triangle meets at the first vertex: comparing each with each would take minutes.
    let count = 60_000;
    let mut text = String::from("v 0 0 1\n");
    for i in 0..count {
        let (sin, cos) = (std::f32::consts::TAU * i as f32 / count as f32).sin_cos();
        text += &format!("v {cos} {sin} 0\n");
    }
    for i in 0..count {
        text += &format!("f 1 {} {}\n", i + 2, (i + 1) % count + 2);
    }
    let mesh = &load(&text).unwrap().parts[0].mesh;
    assert!(mesh.triangles.len() > count / 2);
    let tip = mesh.positions.iter().position(|&p| p == Vec3::Z).unwrap();
    assert!(mesh.normals[tip].abs_diff_eq(Vec3::Z, 1e-3));
}

#[test]
fn broken_files_name_the_line() {
    let table: &[(&str, &str)] = &[
        ("v 0 0\n", "line 1: \"v\" expects 3 numbers, found 2"),
        ("\nv 0 0 x\n", "line 2: \"v\" expects numbers, found \"x\""),
        ("v 0 0 nan\n", "line 1: \"v\" has the number nan, which is not finite"),
        ("v 0 0 1e999\n", "line 1: \"v\" has the number 1e999, which is not finite"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "line 4: the face names vertex 4, but there are 3 up to here"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "line 4: the face names vertex 0, but there are 3 up to here"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -4 1 2\n", "line 4: the face names vertex -4"),
        (
            "v 0 0 0\nvt 0 0\nf 1/-9223372036854775808 1/1 1/1\n",
            "line 3: the face names texture coordinate -9223372036854775808",
        ),
        ("v 0 0 0\nf 1/2 1/2 1/2\n", "line 2: the face names texture coordinate 2, but there are 0 up to here"),
        ("v 0 0 0\nf 1//3 1//3 1//3\n", "line 2: the face names normal 3, but there are 0 up to here"),
        ("v 0 0 0\nf 1/1/1/1 1 1\n", "line 2: "),
        ("v 0 0 0\nf /1 1 1\n", "line 2: "),
        ("v 0 0 0\nf 1 1\n", "line 2: a face needs at least 3 corners, found 2"),
        ("v 0 0 0\nf one two three\n", "line 2: \"one\" is not the number of a vertex"),
        ("", "there are no triangles in it"),
        ("v 0 0 0\nf 1 1 1\n", "there are no triangles in it"),
        ("v 0 0 0\nv 1e30 0 0\nv 0 1e30 0\nf 1 2 3\n", "vertex 1: a number of its position is not finite or above 1e9"),
    ];
    for (text, expected) in table {
        let error = load(text).unwrap_err();
        assert!(error.starts_with(expected), "{text}\n  expected: {expected}\n  found:    {error}");
    }
}

#[test]
fn an_object_without_texture_coordinates_cannot_carry_maps() {
    let (folder, path) = file("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let options = LoadOptions { make_size: 8, ..LoadOptions::default() };
    let scene = |material: &str| {
        let text = format!("{material}\n[[objects]]\nmesh = \"mesh.obj\"\nuv_repeat = 2\n");
        Scene::parse(&text, "scene.toml", folder.path(), &options)
    };
    let error = scene("[materials.wall]\nfrom = \"make:brick-wall\"").unwrap_err().to_string();
    let expected = format!(
        "scene.toml:4: mesh: {}: it has no texture coordinates, which the maps of material \"wall\" need",
        path.display()
    );
    assert!(error.starts_with(&expected), "{error}");
    assert_eq!(scene("[materials.wall]").unwrap().objects[0].material, 0);
    let grey = scene("").unwrap();
    assert_eq!(grey.materials[grey.objects[0].material].name, "grey");
}

#[test]
fn a_folder_or_nothing_at_all_is_no_mesh_file() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path().join("x.obj");
    std::fs::create_dir(&directory).unwrap();
    let error = |path: &Path| Model::load(path, &Limits::default(), true).unwrap_err().message;
    assert_eq!(error(&directory), "this is a folder; name a mesh file");
    assert!(error(&folder.path().join("no.obj")).starts_with("cannot read it: "));
    assert_eq!(error(&folder.path().join("a.fbx")), "expected a file that ends in .glb, .gltf or .obj");
}
