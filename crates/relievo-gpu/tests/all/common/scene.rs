//! Scenes of the tests, and what the CPU and the GPU see of them.

use std::path::Path;

use relievo_cpu::RenderOptions;
use relievo_gpu::{Renderer, RendererOptions};
use relievo_scene::{Aovs, Frame, LoadOptions, Scene};

use super::device::Gpu;

/// A scene with changes (`path=value`), its generated maps of this size; files are those of `scenes/`.
pub fn parse(text: &str, changes: &[&str], make_size: u32) -> Scene {
    let overrides = changes.iter().map(|change| change.parse().unwrap()).collect();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    Scene::parse(text, "test", &folder, &LoadOptions { make_size, overrides, ..LoadOptions::default() }).unwrap()
}

/// The scene as the CPU draws it.
pub fn on_cpu(scene: &Scene) -> Frame {
    relievo_cpu::Renderer::new(scene).unwrap().render(&RenderOptions::default()).unwrap()
}

/// What the GPU measures of the scene.
pub fn measured(gpu: &Gpu, scene: &Scene) -> Aovs {
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue, scene, format, &RendererOptions::default()).unwrap();
    renderer.measure([scene.image.width, scene.image.height]).unwrap()
}
