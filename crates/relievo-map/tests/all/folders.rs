//! Material folders from names to maps.

use std::fs;
use std::path::{Path, PathBuf};

use relievo_map::{
    Grid, HeightMap, Limits, MapError, NormalMap, NormalY, White, find_maps, read_folder, read_height, write_height,
    write_png8,
};

#[test]
fn a_packed_file_and_gloss_become_the_maps_that_they_hold() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let steps = [51.0f32, 102.0, 204.0].map(|v| v / 255.0);
    write_png8(&at("w_arm_1k.png"), &Grid::from_fn(4, 2, |_, _| steps)).unwrap();
    write_height(&at("w_disp_1k.exr"), &HeightMap::new(Grid::from_fn(8, 8, |x, _| x as f32 / 7.0))).unwrap();
    let set = read_folder(folder.path(), &Limits::default()).unwrap().map;
    let first = |map: &Option<relievo_map::ScalarMap>| map.as_ref().unwrap().grid().texels()[0];
    assert_eq!([first(&set.ao), first(&set.roughness), first(&set.metallic)], steps);
    assert_eq!(set.height.unwrap().grid().width(), 8);
    assert!(set.base_color.is_none() && set.normal.is_none());

    fs::remove_file(at("w_arm_1k.png")).unwrap();
    write_png8(&at("w_gloss_1k.png"), &Grid::from_fn(4, 2, |_, _| 0.2f32)).unwrap();
    let set = read_folder(folder.path(), &Limits::default()).unwrap().map;
    assert_eq!(first(&set.roughness), 0.8);
}

#[test]
fn unity_smoothness_is_read_from_alpha_and_missed_aloud() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("w_MetallicSmoothness.png");
    let [metal, smooth] = [51.0f32, 204.0].map(|v| v / 255.0);
    write_png8(&file, &Grid::from_fn(2, 2, |_, _| [metal, 0.0, 0.0, smooth])).unwrap();
    let set = read_folder(folder.path(), &Limits::default()).unwrap().map;
    assert_eq!(set.metallic.unwrap().grid().texels()[0], metal);
    assert_eq!(set.roughness.unwrap().grid().texels()[0], 1.0 - smooth);

    write_png8(&file, &Grid::from_fn(2, 2, |_, _| [metal, 0.0, 0.0])).unwrap();
    let loaded = read_folder(folder.path(), &Limits::default()).unwrap();
    assert!(loaded.map.metallic.is_some() && loaded.map.roughness.is_none());
    let said = |note: &String| note.contains("w_MetallicSmoothness.png") && note.contains("no alpha channel");
    assert!(loaded.notes.iter().any(said), "{:?}", loaded.notes);
}

#[test]
fn directx_normals_are_turned_up_and_depth_is_turned_over() {
    let folder = tempfile::tempdir().unwrap();
    write_png8(&folder.path().join("w_NormalDX.png"), &Grid::from_fn(2, 2, |_, _| [0.5f32, 0.8, 0.9])).unwrap();
    write_png8(&folder.path().join("w_depth.png"), &Grid::from_fn(2, 2, |_, _| 0.2f32)).unwrap();
    let loaded = read_folder(folder.path(), &Limits::default()).unwrap();
    assert_eq!(loaded.map.normal.unwrap().grid().texels()[0][1], -NormalMap::decode8(204));
    assert_eq!(loaded.map.height.unwrap().grid().texels()[0], 0.8);
    assert!(loaded.notes.iter().any(|note| note.contains("256 steps")), "{:?}", loaded.notes);
}

#[test]
fn a_map_that_cannot_be_read_stops_the_folder_with_its_name() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("w_color.png"), "not a picture").unwrap();
    let error = read_folder(folder.path(), &Limits::default()).unwrap_err();
    assert!(matches!(error, MapError::NotAnImage { .. }) && error.to_string().contains("w_color.png"), "{error}");
}

/// A folder of real textures beside the checkout; `None`, said aloud, where there is none.
fn real(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/textures").join(name);
    if path.is_dir() {
        return Some(path);
    }
    eprintln!("skipped: there is no {}", path.display());
    None
}

#[test]
fn real_ambientcg_folders_are_read_whole() {
    for (name, stem) in [("bricks102", "Bricks102"), ("ground054", "Ground054")] {
        let Some(path) = real(name) else { continue };
        let found = find_maps(&path).unwrap();
        let file = |ending: &str| path.join(format!("{stem}_1K-JPG_{ending}.jpg"));
        assert_eq!(found.base_color, Some(file("Color")));
        assert_eq!(found.normal, Some((file("NormalGL"), NormalY::Up)));
        assert_eq!(found.height, Some(file("Displacement")));
        assert!(found.notes.iter().any(|n| n.contains("NormalDX") && n.contains("ignored")), "{:?}", found.notes);
        let set = read_folder(&path, &Limits::default()).unwrap().map;
        let (height, normal) = (set.height.unwrap(), set.normal.unwrap());
        assert_eq!(height.grid().texels().len(), normal.grid().texels().len());
        assert!(set.base_color.is_some() && set.roughness.is_some() && set.ao.is_some() && set.metallic.is_none());
        // Outwards, and not much shorter than normals are: these were made smaller by averaging.
        let mean = |f: fn(&[f32; 3]) -> f32| {
            normal.grid().texels().iter().map(f).sum::<f32>() / normal.grid().texels().len() as f32
        };
        let length = mean(|n| n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        assert!(mean(|n| n[2]) > 0.7 && (0.7..1.05).contains(&length), "{length}");
    }
}

#[test]
fn the_two_conventions_of_a_real_folder_are_the_same_normals() {
    let Some(path) = real("bricks102") else { return };
    let read = |name: &str, y| {
        relievo_map::read_normal(&path.join(format!("Bricks102_1K-JPG_Normal{name}.jpg")), y, &Limits::default())
            .unwrap()
            .map
    };
    let (gl, dx) = (read("GL", NormalY::Up), read("DX", NormalY::Down));
    let apart = |sign: f32| {
        let pairs = gl.grid().texels().iter().zip(dx.grid().texels());
        pairs.map(|(a, b)| (a[1] - sign * b[1]).abs()).sum::<f32>() / gl.grid().texels().len() as f32
    };
    // JPEG blurs both a little; read with the wrong sign they would differ by much more.
    assert!(apart(1.0) < 0.03 && apart(-1.0) > 3.0 * apart(1.0), "{} {}", apart(1.0), apart(-1.0));
}

#[test]
fn a_real_folder_with_plain_names_is_read() {
    let Some(path) = real("bricks102_square") else { return };
    let set = read_folder(&path, &Limits::default()).unwrap().map;
    let height = set.height.unwrap();
    assert_eq!(height, read_height(&path.join("height.png"), White::High, &Limits::default()).unwrap().map);
    assert!(set.base_color.is_some() && set.normal.is_some());
    assert_eq!(height.grid().width(), height.grid().height());
}
