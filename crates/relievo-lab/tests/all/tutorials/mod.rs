//! The tutorials' scenes and pictures, for the tests of every backend.

use std::path::PathBuf;

use relievo_map::Grid;
use relievo_scene::{LoadOptions, Scene};

/// The folder with the scenes and pictures; `None` if it does not exist.
fn folder() -> Option<PathBuf> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/reference");
    if path.is_dir() {
        return Some(path);
    }
    eprintln!("skipped: the reference pictures are not here ({} is not a folder)", path.display());
    None
}

/// All scenes with their names and pictures; none where the folder is missing.
pub(crate) fn scenes() -> Vec<(String, Scene, Grid<[u8; 3]>)> {
    let Some(folder) = folder() else { return Vec::new() };
    let mut names: Vec<String> = std::fs::read_dir(&folder)
        .unwrap()
        .filter_map(|entry| Some(entry.unwrap().file_name().to_str()?.strip_suffix(".toml")?.to_owned()))
        .collect();
    names.sort();
    assert_eq!(names.len(), 22, "the reference scenes are not complete: {names:?}");
    let load = |name: String| {
        let scene = Scene::load(&folder.join(format!("{name}.toml")), &LoadOptions::default()).unwrap();
        let picture = image::open(folder.join(format!("{name}.png"))).unwrap().to_rgb8();
        let (width, height) = picture.dimensions();
        let expected = Grid::new(width, height, picture.pixels().map(|p| p.0).collect()).unwrap();
        (name, scene, expected)
    };
    names.into_iter().map(load).collect()
}
