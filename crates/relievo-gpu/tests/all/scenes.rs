//! The renderer draws the repository's own scenes as the CPU draws them.

use std::path::PathBuf;

use relievo_gpu::{Renderer, RendererOptions};
use relievo_lab::pixel_difference;
use relievo_scene::{LoadOptions, Scene};

use crate::common::device::gpu;
use crate::common::picture::{draw, report};
use crate::common::scene::on_cpu;
use crate::common::tolerances::{PICTURE_MEAN, PICTURE_OVER, PICTURE_THRESHOLD};

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

#[test]
fn every_scene_is_drawn_as_the_cpu_draws_it_or_says_what_is_different() {
    let Some(gpu) = gpu() else { return };
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let (mut compared, mut failed) = (0, Vec::new());
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    paths.sort();
    for path in paths {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let mut scene = Scene::load(&path, &LoadOptions { make_size: 256, ..LoadOptions::default() }).unwrap();
        // A third of the size says as much in a ninth of the time.
        scene.image.width = scene.image.width.div_ceil(3);
        scene.image.height = scene.image.height.div_ceil(3);
        let renderer = Renderer::new(&gpu.device, &gpu.queue, &scene, FORMAT, &RendererOptions::default()).unwrap();
        let expected = on_cpu(&scene).pixels;
        let got = draw(gpu, &scene, FORMAT);
        let difference = pixel_difference(&expected, &got, PICTURE_THRESHOLD).unwrap();
        let notes = renderer.notes();
        println!("{name}: mean {:.3}/255, {:.3} % over {notes:?}", difference.mean, difference.over * 100.0);
        if notes.is_empty() {
            compared += 1;
            if difference.mean > PICTURE_MEAN || difference.over > PICTURE_OVER {
                report(&name, &expected, &got);
                failed.push(name);
            }
        }
    }
    assert!(compared > 0, "no scene was compared");
    assert!(failed.is_empty(), "not the same: {failed:?}");
}
