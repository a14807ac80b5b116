use std::path::Path;

use relievo_scene::{CameraKind, LightKind, LoadOptions, Override, Scene, SceneError};

use crate::scene_files::GOOD;

fn with(changes: &[&str]) -> Result<Scene, SceneError> {
    let overrides = changes.iter().map(|change| change.parse::<Override>().unwrap()).collect();
    let options = LoadOptions { overrides, make_size: 8, ..LoadOptions::default() };
    Scene::parse(GOOD, "scene.toml", Path::new("/nonexistent"), &options)
}

#[test]
fn overrides_change_and_add_what_the_file_says() {
    let scene = with(&[
        "camera.vertical_fov=60",
        "camera.position.2=5",
        "lights.0.intensity=3",
        "lights.3.kind=directional",
        "lights.3.direction=[1, 0, 0]",
        "materials.wall.relief.technique=exact",
        "materials.plain.relief.grid=7",
        "materials.new.base_color=[1, 0, 0]",
        "objects.1.mesh=torus",
        "objects.1.material=new",
    ])
    .unwrap();
    assert_eq!((scene.camera.vertical_fov, scene.camera.position.z), (60.0, 5.0));
    assert_eq!(scene.lights[0].intensity, 3.0);
    assert_eq!(scene.lights[3].kind, LightKind::Directional { direction: glam::Vec3::X });
    assert_eq!(scene.materials[0].relief.technique.name(), "exact");
    assert_eq!(scene.materials[1].relief.grid, 7);
    assert_eq!(scene.materials[2].base_color, [1.0, 0.0, 0.0]);
    assert_eq!(scene.objects[1].material, 2);
    // The last of two wins.
    assert_eq!(with(&["image.width=10", "image.width=20"]).unwrap().image.width, 20);
}

#[test]
fn a_camera_becomes_orthographic_and_shows_so_many_units() {
    assert_eq!(with(&[]).unwrap().camera.kind, CameraKind::Perspective);
    let camera = with(&["camera.kind=orthographic", "camera.size=3.5"]).unwrap().camera;
    assert_eq!((camera.kind, camera.size, camera.half_height()), (CameraKind::Orthographic, 3.5, 1.75));
    assert!(CameraKind::ALL.iter().all(|(name, kind)| kind.name() == *name));
    for (change, message) in [
        ("camera.size=0", "size in [camera] must be a number above 0"),
        ("camera.size=inf", "size in [camera] must be a number above 0"),
        ("camera.size=nan", "size in [camera] must be a number above 0"),
        ("camera.kind=fisheye", "expected one of perspective, orthographic"),
    ] {
        let error = with(&[change]).unwrap_err().to_string();
        assert!(error.contains(message), "{error}");
    }
}

#[test]
fn mistakes_in_overrides_name_the_override() {
    let table: &[(&str, &str)] = &[
        ("camera.fob=1", "--set camera.fob=1: unknown key \"fob\" in [camera]"),
        (
            "camera.vertical_fow=1",
            "--set camera.vertical_fow=1: unknown key \"vertical_fow\" in [camera]; did you mean \"vertical_fov\"?",
        ),
        ("camra.near=1", "--set camra.near=1: unknown key \"camra\" in the scene file; did you mean \"camera\"?"),
        (
            "camera.vertical_fov=wide",
            "--set camera.vertical_fov=wide: vertical_fov in [camera] must be a number above 0",
        ),
        (
            "camera.position=[0, 0, 0]",
            "--set camera.position=[0, 0, 0]: [camera] position and target are the same point",
        ),
        (
            "materials.wall.relief.technique=stepp",
            "--set materials.wall.relief.technique=stepp: technique = \"stepp\" is not known",
        ),
        ("materials.wall.relief=1", "--set materials.wall.relief=1: relief in [materials.wall] must be a table"),
        ("lights.7.intensity=2", "--set lights.7.intensity=2: \"lights\" is a list: \"7\" must be an index, 0 to 2"),
        (
            "lights.first.intensity=2",
            "--set lights.first.intensity=2: \"lights\" is a list: \"first\" must be an index",
        ),
        (
            "lights.0.position.3=2",
            "--set lights.0.position.3=2: \"lights.0.position\" is a list: \"3\" must be an index, 0 to 2",
        ),
        ("objects.0.mesh=nan", "--set objects.0.mesh=nan: mesh in [[objects]] must be one of quad"),
        ("image.width.x=1", "--set image.width.x=1: \"image.width\" is 64, there is nothing to set inside"),
        ("objects=[]", "--set objects=[]: the scene has no [[objects]]"),
        (
            "camera.near=inf",
            "--set camera.near=inf: near in [camera] must be a number above 0, of magnitude at most 1e9, found inf",
        ),
    ];
    for (change, expected) in table {
        let error = with(&[change]).map(|_| ()).unwrap_err().to_string();
        assert!(error.starts_with(expected), "\n  expected: {expected}\n  found:    {error}");
    }
}

#[test]
fn an_endless_path_is_refused() {
    let change = Override { path: vec!["a"; 100_000].join("."), value: "1".to_owned() };
    let options = LoadOptions { overrides: vec![change], ..LoadOptions::default() };
    let error = Scene::parse(GOOD, "scene.toml", Path::new(""), &options).unwrap_err().to_string();
    assert!(error.contains("too many parts"), "{error}");
}
