//! The tutorials' own GLSL drew the pictures in `reference/` beside the repository: ours must be the same.

// A test reports its figures.
#![allow(clippy::print_stdout, clippy::print_stderr)]

use std::path::PathBuf;

use relievo_cpu::{RenderOptions, Renderer};
use relievo_lab::{PixelDifference, pixel_difference};
use relievo_map::Grid;
use relievo_scene::{LoadOptions, Scene};

/// The project's tolerances for a picture drawn by other code on other hardware: bilinear weights and square roots differ
/// in the last bits, and at a silhouette a hair decides between stone and background.
const MEAN: f64 = 1.0;
const OVER: f64 = 0.005;
const THRESHOLD: u8 = 8;

/// The folder with the scenes and pictures, if it stands beside the repository.
fn folder() -> Option<PathBuf> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/reference");
    if path.is_dir() {
        return Some(path);
    }
    eprintln!("skipped: the reference pictures are not here ({} is not a folder)", path.display());
    None
}

fn scenes() -> Vec<(String, Scene, Grid<[u8; 3]>)> {
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

fn difference(scene: &Scene, expected: &Grid<[u8; 3]>) -> PixelDifference {
    let frame = Renderer::new(scene).unwrap().render(&RenderOptions::default()).unwrap();
    pixel_difference(expected, &frame.pixels, THRESHOLD).unwrap()
}

fn same(difference: &PixelDifference) -> bool {
    difference.mean <= MEAN && difference.over <= OVER
}

#[test]
fn every_reference_scene_matches_its_picture() {
    let mut failed = Vec::new();
    for (name, scene, expected) in scenes() {
        let difference = difference(&scene, &expected);
        println!(
            "{name:20} mean {:.4}/255, {:.3} % of pixels over {THRESHOLD}/255, at most {}",
            difference.mean,
            difference.over * 100.0,
            difference.max
        );
        if !same(&difference) {
            failed.push(name);
        }
    }
    assert!(failed.is_empty(), "not the same: {failed:?}");
}

#[test]
fn a_broken_formula_is_caught() {
    // One number wrong on purpose in every scene: the height a little off, or, where height plays no part, the highlight.
    for (name, mut scene, expected) in scenes() {
        if name.ends_with("normal") {
            scene.shading.specular *= 2.0;
        }
        for material in &mut scene.materials {
            if let relievo_scene::HeightRange::Scale(scale) = &mut material.height {
                *scale *= 0.9;
            }
        }
        assert!(!same(&difference(&scene, &expected)), "{name} passes although it is drawn wrongly");
    }
}
