//! Reliefs at a distance: pictures with one sample per pixel against displaced geometry with hundreds.

use std::path::Path;

use glam::Vec3;
use relievo_cpu::{RenderOptions, Renderer};
use relievo_lab::{DEFAULT_PIXELS_PER_DEGREE, flip, pixel_difference};
use relievo_map::Grid;
use relievo_march::Technique;
use relievo_scene::{Filter, LoadOptions, Scene, SurfaceTechnique};

pub(crate) type Picture = Grid<[u8; 3]>;

/// Samples per pixel of the truth.
pub(crate) const TRUTH_SAMPLES: u32 = 256;

/// A relief under test.
pub(crate) struct Subject {
    pub(crate) name: &'static str,
    /// The scene at its nearest distance.
    pub(crate) scene: Scene,
    /// Vertices per side of the displaced truth.
    pub(crate) grid: u32,
}

/// Sampling of the maps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sampling {
    Linear,
    Trilinear,
    Lod,
}

/// Image errors and cost of a technique, as means over the frames.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ImageError {
    pub(crate) flip: f64,
    pub(crate) psnr: f64,
    /// Mean difference from frame to frame, in 1/255.
    pub(crate) change: f64,
    /// Height look-ups per pixel.
    pub(crate) fetches: f64,
}

/// A scene of this repository, its generated maps of this size.
pub(crate) fn subject(name: &'static str, file: &str, make_size: u32) -> Subject {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(file);
    let scene = Scene::load(&path, &LoadOptions { make_size, ..LoadOptions::default() }).expect("the scene loads");
    let repeat = scene.objects[0].uv_repeat.max_element();
    Subject { name, scene, grid: (make_size as f32 * repeat) as u32 * 2 + 1 }
}

/// A cobbled floor to the horizon under a low sun.
pub(crate) fn floor(make_size: u32) -> Subject {
    let text = r#"
        [image]
        width = 160
        height = 60
        [camera]
        position = [0.0, 0.5, 4.0]
        target = [0.0, 0.1, 0.0]
        vertical_fov = 22.0
        [[lights]]
        kind = "directional"
        direction = [-0.6, -0.5, -0.6]
        intensity = 1.2
        [shading]
        model = "blinn-phong"
        ambient = 0.28
        specular = 0.25
        shininess = 40.0
        [materials.cobbles]
        from = "make:cobbles"
        height_scale = 0.05
        [materials.cobbles.relief]
        technique = "exact"
        shadow = "exact"
        [[objects]]
        mesh = "plane"
        material = "cobbles"
        scale = [4.0, 1.0, 4.0]
        uv_repeat = [8, 8]
    "#;
    let options = LoadOptions { make_size, ..LoadOptions::default() };
    let scene = Scene::parse(text, "floor", Path::new(""), &options).expect("the floor loads");
    Subject { name: "floor", scene, grid: make_size * 8 * 2 + 1 }
}

/// The scene from `times` the distance, in a picture cut to its extent: pixels keep their size.
pub(crate) fn from_afar(scene: &Scene, times: f32) -> Scene {
    let mut scene = scene.clone();
    let camera = &mut scene.camera;
    camera.position = camera.target + (camera.position - camera.target) * times;
    let [width, height] = [scene.image.width, scene.image.height].map(|n| (n as f32 / times).ceil() as u32);
    let half = (camera.vertical_fov.to_radians() * 0.5).tan() * height as f32 / scene.image.height as f32;
    camera.vertical_fov = (half.atan() * 2.0).to_degrees();
    (scene.image.width, scene.image.height) = (width, height);
    scene
}

/// The scene with the camera moved sideways by a fraction of a pixel per frame.
pub(crate) fn frames(scene: &Scene, count: u32) -> Vec<Scene> {
    let camera = scene.camera;
    let forward = camera.target - camera.position;
    let pixel = 2.0 * (camera.vertical_fov.to_radians() * 0.5).tan() * forward.length() / scene.image.height as f32;
    let right = forward.cross(camera.up).normalize();
    let up = right.cross(forward).normalize();
    (0..count)
        .map(|i| {
            let mut scene = scene.clone();
            let aside: Vec3 = (right * 0.31 + up * 0.17) * (pixel * i as f32);
            scene.camera.position += aside;
            scene.camera.target += aside;
            scene
        })
        .collect()
}

/// The truth: displaced geometry with many samples per pixel.
pub(crate) fn truth(frames: &[Scene], grid: u32) -> Vec<Picture> {
    frames
        .iter()
        .map(|scene| {
            let mut scene = scene.clone();
            scene.image.samples = TRUTH_SAMPLES;
            for material in &mut scene.materials {
                material.relief.technique = SurfaceTechnique::Displacement;
                material.relief.grid = grid;
            }
            draw(&scene).0
        })
        .collect()
}

/// Frames of a technique, one sample per pixel, lit at the hit; and the look-ups per pixel.
pub(crate) fn technique_frames(frames: &[Scene], technique: Technique, sampling: Sampling) -> (Vec<Picture>, f64) {
    let drawn: Vec<(Picture, f64)> = frames
        .iter()
        .map(|scene| {
            let mut scene = scene.clone();
            for material in &mut scene.materials {
                material.relief.technique = SurfaceTechnique::Marched(technique);
                material.relief.write_depth = Some(true);
                material.relief.lod = sampling == Sampling::Lod;
                material.filter = if sampling == Sampling::Linear { Filter::Linear } else { Filter::Trilinear };
            }
            draw(&scene)
        })
        .collect();
    let fetches = drawn.iter().map(|(_, fetches)| fetches).sum::<f64>() / drawn.len() as f64;
    (drawn.into_iter().map(|(picture, _)| picture).collect(), fetches)
}

/// Compares frames with the truth's, which may be fewer.
pub(crate) fn image_error(truth: &[Picture], (pictures, fetches): &(Vec<Picture>, f64)) -> ImageError {
    let count = truth.len() as f64;
    let pairs = || truth.iter().zip(pictures);
    let flips = pairs().map(|(a, b)| flip(a, b, DEFAULT_PIXELS_PER_DEGREE).expect("equal sizes").mean);
    // The mean of the squared errors, in decibels.
    let squares = pairs().map(|(a, b)| 10f64.powf(-0.1 * pixel_difference(a, b, 0).expect("equal sizes").psnr));
    ImageError {
        flip: flips.sum::<f64>() / count,
        psnr: -10.0 * (squares.sum::<f64>() / count).log10(),
        change: change(pictures),
        fetches: *fetches,
    }
}

/// Mean difference from frame to frame, in 1/255.
pub(crate) fn change(pictures: &[Picture]) -> f64 {
    let steps = pictures.windows(2).map(|pair| pixel_difference(&pair[0], &pair[1], 0).expect("equal sizes").mean);
    steps.sum::<f64>() / (pictures.len() - 1).max(1) as f64
}

fn draw(scene: &Scene) -> (Picture, f64) {
    let renderer = Renderer::new(scene).expect("the scene is whole");
    let frame = renderer.render(&RenderOptions::default()).expect("the scene can be drawn");
    let fetches = frame.aovs.fetches.texels();
    let mean = fetches.iter().map(|&n| f64::from(n)).sum::<f64>() / fetches.len() as f64;
    (frame.pixels, mean)
}
