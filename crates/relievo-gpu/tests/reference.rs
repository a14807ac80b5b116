//! The renderer draws the tutorials' own pictures, in `reference/` beside the repository, and what the CPU draws.

// A test reports its figures.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod common;

use std::path::PathBuf;

use common::device::gpu;
use common::picture::{draw, report};
use common::tolerances::{PICTURE_MEAN, PICTURE_OVER, PICTURE_THRESHOLD};
use relievo_cpu::RenderOptions;
use relievo_lab::{PixelDifference, pixel_difference};
use relievo_map::Grid;
use relievo_scene::{HeightRange, LoadOptions, Scene};

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

fn same(difference: &PixelDifference) -> bool {
    difference.mean <= PICTURE_MEAN && difference.over <= PICTURE_OVER
}

fn said(difference: &PixelDifference) -> String {
    let PixelDifference { mean, over, max, .. } = difference;
    format!("mean {mean:.4}/255, {:.3} % over {PICTURE_THRESHOLD}/255, at most {max}", over * 100.0)
}

#[test]
fn every_reference_scene_is_drawn_as_the_tutorials_and_the_cpu_draw_it() {
    let Some(gpu) = gpu() else { return };
    let mut failed = Vec::new();
    for (name, scene, expected) in scenes() {
        let got = draw(gpu, &scene, wgpu::TextureFormat::Rgba8Unorm);
        let on_cpu = relievo_cpu::Renderer::new(&scene).unwrap().render(&RenderOptions::default()).unwrap().pixels;
        let to_tutorial = pixel_difference(&expected, &got, PICTURE_THRESHOLD).unwrap();
        let to_cpu = pixel_difference(&on_cpu, &got, PICTURE_THRESHOLD).unwrap();
        println!("{name:20} tutorial: {}; CPU: {}", said(&to_tutorial), said(&to_cpu));
        if !same(&to_tutorial) || !same(&to_cpu) {
            report(&name, &on_cpu, &got);
            failed.push(name);
        }
    }
    assert!(failed.is_empty(), "not the same: {failed:?}");
}

#[test]
fn a_height_a_tenth_off_is_caught() {
    let Some(gpu) = gpu() else { return };
    for (name, mut scene, expected) in scenes() {
        if name.ends_with("normal") {
            scene.shading.specular *= 2.0;
        }
        for material in &mut scene.materials {
            if let HeightRange::Scale(scale) = &mut material.height {
                *scale *= 0.9;
            }
        }
        let got = draw(gpu, &scene, wgpu::TextureFormat::Rgba8Unorm);
        let difference = pixel_difference(&expected, &got, PICTURE_THRESHOLD).unwrap();
        assert!(!same(&difference), "{name} passes although it is drawn wrongly");
    }
}
