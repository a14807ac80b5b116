//! Mist: what it takes, what it refuses, the space it fills.

use glam::{Affine3A, Vec3};
use relievo_march::Shadow;
use relievo_scene::{Camera, InvalidScene, MistError, MistVolume, Scene, mist_order};

use crate::scene_files::parse;

const FOG: &str = r#"
[materials.fog]
kind = "mist"
from = "make:brick-wall"
depth = 0.5
midlevel = 0.25
[materials.fog.mist]
density = 2.5
softness = 0.2
anisotropy = -0.3
steps = 7
[[objects]]
mesh = "quad"
rotate = [20, 30, 40]
translate = [1, 2, 3]
uv_repeat = [2, 3]
"#;

#[test]
fn every_key_is_read_and_light_is_shadowed_unless_the_file_says_otherwise() {
    let scene = parse(FOG).unwrap();
    let mist = scene.materials[0].mist.unwrap();
    assert_eq!((mist.density, mist.softness, mist.anisotropy, mist.steps), (2.5, 0.2, -0.3, 7));
    assert_eq!(scene.materials[0].relief.shadow, Shadow::Exact);
    let unshadowed =
        parse(&FOG.replace("[[objects]]", "[materials.fog.relief]\nshadow = \"none\"\n[[objects]]")).unwrap();
    assert_eq!(unshadowed.materials[0].relief.shadow, Shadow::None);
    let plain = parse("materials.a.from = \"make:brick-wall\"\n[[objects]]\nmesh = \"quad\"").unwrap();
    assert!(!plain.materials[0].is_mist() && plain.mist_volumes().unwrap().is_empty());
}

#[test]
fn what_cannot_be_mist_is_an_error_at_its_line() {
    let relief = |line: &str| FOG.replace("[[objects]]", &format!("[materials.fog.relief]\n{line}\n[[objects]]"));
    for (text, says) in [
        (
            FOG.replace("density = 2.5", "density = -1"),
            "scene.toml:8: density in [materials.fog.mist] must be a number, 0 or more",
        ),
        (
            FOG.replace("density = 2.5", "density = nan"),
            "scene.toml:8: density in [materials.fog.mist] must be a number, 0 or more",
        ),
        (FOG.replace("density = 2.5", "density = inf"), "scene.toml:8: density"),
        (
            FOG.replace("-0.3", "1"),
            "scene.toml:10: anisotropy in [materials.fog.mist] must be a number above -1 and below 1",
        ),
        (FOG.replace("-0.3", "-1.5"), "scene.toml:10: anisotropy"),
        (FOG.replace("0.2\n", "1.1\n"), "scene.toml:9: softness in [materials.fog.mist] must be a number from 0 to 1"),
        (
            FOG.replace("steps = 7", "steps = 0"),
            "scene.toml:11: steps in [materials.fog.mist] must be a whole number from 1 to 64",
        ),
        (FOG.replace("steps", "step"), "did you mean \"steps\""),
        (FOG.replace("kind = \"mist\"\n", ""), "[materials.fog.mist] is for kind = \"mist\""),
        (FOG.replace("\"mist\"", "\"mits\""), "did you mean \"mist\""),
        (
            relief("technique = \"steep\""),
            "scene.toml:13: [materials.fog] is mist, but its technique is \"steep\"; mist is marched by \"exact\" alone",
        ),
        (relief("shadow = \"soft\""), "scene.toml:13: [materials.fog] is mist, but its shadow is \"soft\""),
        (relief("edge = \"silhouette\""), "scene.toml:13: [materials.fog] is mist, but its edge is \"silhouette\""),
        (relief("lod = true"), "scene.toml:13: [materials.fog] is mist, but it has lod = true"),
        (
            FOG.replace("from = \"make:brick-wall\"\n", ""),
            "scene.toml:3: material \"fog\" is mist, but it has no height map",
        ),
        (FOG.replace("\"quad\"", "\"sphere\""), "scene.toml:13: material \"fog\" is mist, but its mesh is not flat"),
        (FOG.replace("\"quad\"", "\"cube\""), "its mesh is not flat"),
    ] {
        let error = parse(&text).unwrap_err().to_string();
        assert!(error.contains(says), "{error}\ninstead of\n{says}");
    }
}

#[test]
fn scenes_made_in_code_are_refused_too() {
    type Change = fn(&mut Scene);
    let changes: [(Change, &str); 4] = [
        (|scene| scene.materials[0].mist.as_mut().unwrap().density = f32::NAN, "its density is NaN"),
        (|scene| scene.materials[0].mist.as_mut().unwrap().anisotropy = f32::NAN, "its anisotropy is NaN"),
        (|scene| scene.materials[0].maps.height = None, "no height map"),
        (|scene| scene.objects[0].mesh = std::sync::Arc::new(relievo_scene::Mesh::shape("torus").unwrap()), "not flat"),
    ];
    for (change, says) in changes {
        let mut scene = parse(FOG).unwrap();
        scene.validate().unwrap();
        change(&mut scene);
        let error = scene.validate().unwrap_err();
        assert!(matches!(error, InvalidScene::Mist { material: 0, .. }) && error.to_string().contains(says), "{error}");
    }
}

#[test]
fn the_space_lies_over_the_mesh_between_floor_and_lid() {
    let scene = parse(FOG).unwrap();
    let volume = &scene.mist_volumes().unwrap()[0];
    let transform = scene.objects[0].transform;
    assert_eq!(volume.planes.len(), 6);
    // The polygon lies a quarter of the depth above the floor.
    let inside = |x: f32, y: f32, z: f32| {
        let point = transform.transform_point3(Vec3::new(x, y, z));
        volume.planes.iter().all(|plane| plane.truncate().dot(point) >= plane.w)
    };
    for (x, y, z, is_inside) in [
        (0.0, 0.0, 0.0, true),
        (0.99, -0.99, 0.37, true),
        (0.0, 0.0, 0.38, false),
        (-0.9, 0.9, -0.12, true),
        (0.0, 0.0, -0.13, false),
        (1.01, 0.0, 0.0, false),
        (0.0, -1.01, 0.0, false),
    ] {
        assert_eq!(inside(x, y, z), is_inside, "{x} {y} {z}");
    }
    // A ray straight down enters at height 1 and leaves at 0, over the uv that the quad has there.
    let down = transform.transform_vector3(-Vec3::Z).normalize();
    let origin = transform.transform_point3(Vec3::new(0.5, 0.25, 2.0));
    let span = volume.span(origin, down, [0.0, 10.0]).unwrap();
    assert!((span.length - 0.5).abs() < 1e-5 && (span.ray.height - 1.0).abs() < 1e-5, "{span:?}");
    assert!((span.ray.height_delta + 2.0).abs() < 1e-5, "{span:?}");
    assert!((span.ray.uv[0] - 1.5).abs() < 1e-5 && (span.ray.uv[1] - 1.125).abs() < 1e-5, "{span:?}");
    assert_eq!(volume.span(origin, -down, [0.0, 10.0]), None);
    let cut = volume.span(origin, down, [0.0, span.start + 0.1]).unwrap();
    assert!((cut.length - 0.1).abs() < 1e-5);
}

#[test]
fn turned_texture_coordinates_and_round_outlines_keep_the_mesh_outline() {
    let turned = parse(&FOG.replace("midlevel = 0.25", "uv_rotate = 33")).unwrap();
    let volume = &turned.mist_volumes().unwrap()[0];
    let corner = turned.objects[0].transform.transform_point3(Vec3::new(0.99, 0.99, -0.1));
    let beside = turned.objects[0].transform.transform_point3(Vec3::new(1.05, 0.0, -0.1));
    let inside = |point: Vec3| volume.planes.iter().all(|plane| plane.truncate().dot(point) >= plane.w);
    assert!(inside(corner) && !inside(beside));
}

#[test]
fn an_outline_with_too_many_corners_is_refused() {
    let mut scene = parse(FOG).unwrap();
    let quad = relievo_scene::Mesh::shape("quad").unwrap();
    let count = 40;
    let rim = |i: u32| (f64::from(i) / f64::from(count) * std::f64::consts::TAU).sin_cos();
    let points: Vec<[f32; 2]> = (0..count).map(rim).map(|(y, x)| [x as f32, y as f32]).collect();
    let mesh = relievo_scene::Mesh {
        positions: points.iter().map(|&[x, y]| Vec3::new(x, y, 0.0)).collect(),
        normals: vec![Vec3::Z; points.len()],
        tangents: vec![quad.tangents[0]; points.len()],
        uvs: points.iter().map(|&[x, y]| glam::Vec2::new(x, -y)).collect(),
        triangles: (1..count - 1).map(|i| [0, i, i + 1]).collect(),
    };
    scene.objects[0].mesh = std::sync::Arc::new(mesh);
    assert_eq!(MistVolume::new(&scene, 0), Err(MistError::Outline { corners: 40 }));
}

#[test]
fn a_mist_before_another_is_drawn_after_it() {
    let mut scene = parse(FOG).unwrap();
    let below = scene.objects[0].clone();
    let mut above = below.clone();
    // Along the normal, clear of the other.
    above.transform *= Affine3A::from_translation(Vec3::new(0.3, 0.0, 0.9));
    scene.objects = vec![above, below];
    let volumes = scene.mist_volumes().unwrap();
    let at = |z: f32| Camera {
        position: scene.objects[1].transform.transform_point3(Vec3::new(0.1, 0.2, z)),
        ..Camera::default()
    };
    assert_eq!(mist_order(&volumes, &at(5.0)), [1, 0]);
    assert_eq!(mist_order(&volumes, &at(-5.0)), [0, 1]);
    // From between them, and from within one.
    assert_eq!(mist_order(&volumes, &at(0.9)), [1, 0]);
}
