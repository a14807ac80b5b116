use std::path::{Path, PathBuf};

use relievo_scene::LoadOptions;
use relievo_scene::{Scene, SceneError};

pub(crate) fn parse(text: &str) -> Result<Scene, SceneError> {
    Scene::parse(
        text,
        "scene.toml",
        Path::new("/nonexistent"),
        &LoadOptions { make_size: 16, ..LoadOptions::default() },
    )
}

/// The folder of pictures and scenes beside the checkout, if it is there.
fn shared() -> Option<PathBuf> {
    let shared = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    shared.join("reference").is_dir().then_some(shared)
}

#[test]
fn every_reference_scene_loads() {
    let Some(shared) = shared() else {
        eprintln!("skipped: there is no folder of reference scenes beside the checkout");
        return;
    };
    let mut loaded = 0;
    for entry in shared.join("reference").read_dir().unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            let scene = Scene::load(&path, &LoadOptions::default()).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!((scene.image.width, scene.image.height), (480, 360));
            assert_eq!((scene.lights.len(), scene.materials.len(), scene.objects.len()), (1, 1, 1));
            let maps = &scene.materials[0].maps;
            assert!(maps.base_color.is_some() && maps.normal.is_some() && maps.height.is_some());
            assert!(path.file_stem().unwrap().to_str().unwrap().contains(scene.materials[0].relief.technique.name()));
            loaded += 1;
        }
    }
    assert!(loaded >= 22, "{loaded}");
}
