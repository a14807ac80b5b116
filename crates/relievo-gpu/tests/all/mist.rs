//! Mist drawn as the CPU draws it: cameras, lights, models, wrap modes, several at once.

use std::path::Path;

use crate::common::device::gpu;
use crate::common::picture::{draw, draw_with, report};
use crate::common::tolerances::{PICTURE_MEAN, PICTURE_OVER, PICTURE_THRESHOLD};
use relievo_cpu::RenderOptions;
use relievo_gpu::{Renderer, RendererOptions};
use relievo_lab::{PixelDifference, pixel_difference};
use relievo_map::Grid;
use relievo_scene::{LoadOptions, Scene};

const PLAIN: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Rocks in fog under a sun and a lamp, with a second layer over them, with changes.
fn scene(changes: &[&str]) -> Scene {
    let text = r#"
        [image]
        width = 120
        height = 90
        background = [0.4, 0.5, 0.7]
        [camera]
        position = [0.5, -2.2, 1.3]
        up = [0, 0, 1]
        [[lights]]
        kind = "directional"
        direction = [0.8, 0.3, -0.5]
        color = [1.0, 0.8, 0.6]
        intensity = 1.5
        [[lights]]
        kind = "point"
        position = [0.4, 0.3, 0.7]
        color = [0.5, 0.7, 1.0]
        [shading]
        ambient = 0.15
        [materials.rocks]
        from = "make:cobbles"
        height_scale = 0.2
        [materials.rocks.relief]
        shadow = "exact"
        edge = "clip"
        [materials.ball]
        base_color = [0.8, 0.3, 0.2]
        [materials.ball.relief]
        technique = "none"
        shadow = "exact"
        [materials.fog]
        kind = "mist"
        from = "make:cloud-tops"
        base_color = [0.9, 0.95, 1.0]
        depth = 0.3
        [materials.fog.mist]
        density = 8.0
        softness = 0.15
        anisotropy = 0.4
        steps = 10
        [materials.fog.relief]
        shadow = "exact"
        [materials.veil]
        kind = "mist"
        from = "make:fog-bank"
        depth = 0.2
        midlevel = 0.5
        [materials.veil.mist]
        density = 1.5
        steps = 3
        [[objects]]
        mesh = "quad"
        material = "rocks"
        [[objects]]
        mesh = "quad"
        material = "fog"
        translate = [0.1, 0.0, 0.02]
        scale = [1.2, 0.9, 1]
        uv_repeat = 2
        [[objects]]
        mesh = "quad"
        material = "veil"
        translate = [0.0, 0.2, 0.3]
        rotate = [0, 0, 30]
        scale = 0.7
        [[objects]]
        mesh = "sphere"
        material = "ball"
        translate = [-0.4, -0.2, 0.1]
        scale = 0.2
    "#;
    let overrides = changes.iter().map(|change| change.parse().unwrap()).collect();
    let options = LoadOptions { make_size: 96, overrides, ..LoadOptions::default() };
    Scene::parse(text, "mist", Path::new("."), &options).unwrap()
}

fn on_cpu(scene: &Scene) -> Grid<[u8; 3]> {
    relievo_cpu::Renderer::new(scene).unwrap().render(&RenderOptions::default()).unwrap().pixels
}

fn same(difference: &PixelDifference) -> bool {
    difference.mean <= PICTURE_MEAN && difference.over <= PICTURE_OVER
}

#[test]
fn mist_is_drawn_as_on_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let cases: [&[&str]; 11] = [
        &[],
        &["image.samples=3"],
        &["shading.model=pbr", "lights.0.intensity=4", "lights.1.intensity=2"],
        &["shading.color_space=display"],
        &["camera.kind=orthographic", "camera.size=2.4"],
        // Within the fog, below it, and between the two layers.
        &["camera.position=[0.2,-0.9,-0.1]", "camera.target=[0,0.5,0.1]"],
        &["camera.position=[0.3,-1.5,-1.0]"],
        &["camera.position=[0.2,-1.0,0.12]", "camera.target=[0,0.5,0.1]"],
        &["materials.fog.wrap=mirror", "materials.fog.uv_rotate=20"],
        &["materials.fog.wrap=clamp", "materials.fog.filter=nearest", "materials.fog.mist.softness=0"],
        &["materials.fog.relief.shadow=none", "materials.fog.mist.anisotropy=-0.5", "materials.fog.midlevel=0.3"],
    ];
    let mut failed = Vec::new();
    for changes in cases {
        let scene = scene(changes);
        let (expected, got) = (on_cpu(&scene), draw(gpu, &scene, PLAIN));
        let difference = pixel_difference(&expected, &got, PICTURE_THRESHOLD).unwrap();
        println!("{changes:?}: mean {:.3}/255, {:.3} % over", difference.mean, difference.over * 100.0);
        if !same(&difference) {
            report(&format!("mist-{}", failed.len()), &expected, &got);
            failed.push(changes);
        }
    }
    assert!(failed.is_empty(), "not the same: {failed:?}");
}

#[test]
fn what_is_wrong_with_the_mist_is_seen() {
    let Some(gpu) = gpu() else { return };
    let expected = on_cpu(&scene(&[]));
    // Thinner, without its shadows, scattered elsewhere, in another place: each is told from what it should be.
    for wrong in [
        "materials.fog.mist.density=5",
        "materials.fog.relief.shadow=none",
        "materials.fog.mist.anisotropy=-0.2",
        "materials.veil.mist.density=0",
        "objects.1.translate=[0.4,0,0.02]",
        "materials.fog.mist.softness=0.6",
    ] {
        let got = draw(gpu, &scene(&[wrong]), PLAIN);
        let difference = pixel_difference(&expected, &got, PICTURE_THRESHOLD).unwrap();
        assert!(!same(&difference), "{wrong} is not seen: {difference:?}");
    }
}

#[test]
fn mist_follows_changed_reliefs_lights_and_cameras() {
    let Some(gpu) = gpu() else { return };
    let (before, after) = (scene(&[]), scene(&["materials.fog.mist.density=3", "camera.position=[-0.8,-2,1]"]));
    let options = RendererOptions::default();
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue, &before, PLAIN, &options).unwrap();
    let size = [before.image.width, before.image.height];
    draw_with(gpu, &mut renderer, size, PLAIN);
    let mut after = after;
    after.lights.truncate(1);
    renderer.set_reliefs(&after).unwrap();
    renderer.set_camera(&after.camera).unwrap();
    renderer.set_lights(&after.lights).unwrap();
    assert_eq!(draw_with(gpu, &mut renderer, size, PLAIN), draw(gpu, &after, PLAIN));
}

#[test]
fn with_multisampling_and_a_depth_prepass_mist_stays_where_it_is() {
    let Some(gpu) = gpu() else { return };
    let scene = scene(&[]);
    let expected = on_cpu(&scene);
    let size = [scene.image.width, scene.image.height];
    for options in [
        RendererOptions { depth_prepass: true, ..RendererOptions::default() },
        RendererOptions { msaa: 4, ..RendererOptions::default() },
    ] {
        let mut renderer = Renderer::new(&gpu.device, &gpu.queue, &scene, PLAIN, &options).unwrap();
        let got = draw_with(gpu, &mut renderer, size, PLAIN);
        let difference = pixel_difference(&expected, &got, PICTURE_THRESHOLD).unwrap();
        println!("{options:?}: mean {:.3}/255, {:.3} % over", difference.mean, difference.over * 100.0);
        // Smoothed borders differ.
        assert!(difference.mean <= PICTURE_MEAN && difference.over <= 0.06, "{options:?}: {difference:?}");
    }
}
