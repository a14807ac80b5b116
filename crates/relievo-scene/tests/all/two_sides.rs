//! Reliefs that are seen from behind.

use relievo_scene::{LoadOptions, Scene};

/// The notes on a relief on this mesh, seen from this eye; `more` are lines of its material.
fn notes(mesh: &str, eye: [f32; 3], target: [f32; 3], more: &str) -> Vec<String> {
    let text = format!(
        "camera = {{ position = {eye:?}, target = {target:?} }}\n[materials.iron]\nfrom = \"make:brick-wall\"\n{more}\n\
         [[objects]]\nmesh = \"{mesh}\"\nscale = [-1, 1, 1]\n"
    );
    let options = LoadOptions { make_size: 16, ..LoadOptions::default() };
    let scene = Scene::parse(&text, "scene.toml", std::path::Path::new("."), &options).unwrap();
    scene.notes_on_unseen_reliefs()
}

#[test]
fn a_relief_seen_from_behind_alone_is_noted_once() {
    let (front, back, middle) = ([0.3, 0.2, 3.0], [0.3, 0.2, -3.0], [0.0; 3]);
    let noted = notes("quad", back, middle, "");
    assert_eq!(noted.len(), 1);
    assert!(noted[0].contains("\"iron\" is seen from behind") && noted[0].contains("two_sided = true"), "{noted:?}");
    assert_eq!(notes("quad", back, middle, "relief.technique = \"displacement\"").len(), 1);
    // A room seen from within.
    assert_eq!(notes("cube", [0.1, 0.0, 0.2], middle, "").len(), 1);
    for (mesh, eye, target, more) in [
        ("quad", front, middle, ""),
        ("quad", back, middle, "two_sided = true"),
        ("quad", back, middle, "relief.technique = \"normal\""),
        ("quad", back, [0.0, 0.0, -9.0], ""),
        ("quad", back, [9.0, 0.0, -3.0], ""),
        ("cube", front, middle, ""),
        ("torus", front, middle, ""),
    ] {
        assert_eq!(notes(mesh, eye, target, more), Vec::<String>::new(), "{mesh} from {eye:?} {more}");
    }
    // Behind something that hides it nothing of it is missed; beside that it is.
    let hidden_by = |scale: f32| {
        let more =
            format!("[[objects]]\nmesh = \"quad\"\ntranslate = [0, 0, -1]\nrotate = [0, 180, 0]\nscale = {scale}");
        notes("quad", back, middle, &more)
    };
    assert_eq!((hidden_by(2.0).len(), hidden_by(0.3).len()), (0, 1));
}
