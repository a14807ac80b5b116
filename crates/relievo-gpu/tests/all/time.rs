//! Scenes over time: frames on the device are those of the CPU, and those of the device alone.

use std::path::Path;

use crate::common::device::gpu;
use crate::common::picture::{draw, draw_with, report};
use crate::common::tolerances::{PICTURE_MEAN, PICTURE_OVER, PICTURE_THRESHOLD};
use relievo_cpu::RenderOptions;
use relievo_gpu::{GpuError, Renderer, RendererOptions};
use relievo_lab::pixel_difference;
use relievo_map::Grid;
use relievo_scene::{AnimatedScene, LoadOptions, Scene, SceneTime};

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Changing heights by a recipe and by layers, moving maps, a turning object, and a light that swings.
const FILM: &str = r#"
    [image]
    width = 160
    height = 110
    [time]
    loop = 4
    [[lights]]
    kind = "directional"
    direction = [-0.5, -1, -0.4]
    [camera]
    position = [0, 1, 2]
    [materials.clouds]
    height = "make:clouds"
    height_size = 128
    uv_velocity = [0.25, 0]
    relief.shadow = "exact"
    [materials.stones]
    base_color = [0.9, 0.7, 0.5]
    height = "make:cobbles"
    layers = [{ velocity = [0.25, 0] }, { velocity = [0, -0.5], repeat = 2 }]
    layer_blend = "max"
    [[objects]]
    mesh = "plane"
    material = "clouds"
    [[objects]]
    mesh = "cube"
    material = "stones"
    scale = 0.3
    translate = [0, 0.3, 0]
    [[animate]]
    key = "objects.1.rotate"
    loop = true
    keys = [{ time = 0, value = [0, 0, 0] }, { time = 4, value = [0, 360, 0] }]
    [[animate]]
    key = "lights.0.direction"
    keys = [{ time = 0, value = [-0.5, -1, -0.4] }, { time = 2, value = [0.5, -1, -0.4] }, { time = 4, value = [-0.5, -1, -0.4] }]
    [[animate]]
    key = "image.background"
    keys = [{ time = 0, value = [0, 0, 0] }, { time = 2, value = [0, 0, 1] }, { time = 4, value = [0, 0, 0] }]
"#;

const TIMES: [f64; 5] = [0.0, 0.7, 1.5, 2.25, 3.9];

fn film(overrides: &[&str]) -> AnimatedScene {
    let overrides = overrides.iter().map(|change| change.parse().unwrap()).collect();
    let options = LoadOptions { make_size: 64, overrides, ..LoadOptions::default() };
    AnimatedScene::parse(FILM, "film.toml", Path::new(""), &options).unwrap()
}

fn at(seconds: f64) -> SceneTime {
    SceneTime::from_seconds(seconds).unwrap()
}

fn on_cpu(scene: &Scene) -> Grid<[u8; 3]> {
    relievo_cpu::Renderer::new(scene).unwrap().render(&RenderOptions::default()).unwrap().pixels
}

fn is_near(name: &str, expected: &Grid<[u8; 3]>, got: &Grid<[u8; 3]>) -> bool {
    let difference = pixel_difference(expected, got, PICTURE_THRESHOLD).unwrap();
    println!("{name}: mean {:.3}, {:.4} over", difference.mean, difference.over);
    let near = difference.mean <= PICTURE_MEAN && difference.over <= PICTURE_OVER;
    if !near {
        report(name, expected, got);
    }
    near
}

#[test]
fn frames_on_the_device_are_those_of_the_cpu_at_five_times() {
    let Some(gpu) = gpu() else { return };
    // Heights made on the device, and by every way in which they are made on the CPU instead.
    let cases: [(&str, &[&str], usize); 4] = [
        ("device", &[], 0),
        ("lod", &["materials.clouds.relief.lod=true"], 1),
        ("displaced", &["materials.clouds.relief.technique=displacement", "materials.stones.relief.technique=cone"], 2),
        ("two-sided", &["materials.clouds.two_sided=true"], 1),
    ];
    for (name, overrides, on_host) in cases {
        let film = film(overrides);
        let first = film.at(at(0.0)).unwrap();
        let mut renderer = Renderer::new(&gpu.device, &gpu.queue, &first, FORMAT, &RendererOptions::default()).unwrap();
        let notes = renderer.notes();
        assert_eq!(notes.iter().filter(|note| note.contains("are made on the CPU")).count(), on_host, "{notes:?}");
        let mut frames: Vec<Grid<[u8; 3]>> = Vec::new();
        for seconds in TIMES {
            renderer.set_scene(&film.at_without_heights(at(seconds)).unwrap()).unwrap();
            let got = draw_with(gpu, &mut renderer, [160, 110], FORMAT);
            let expected = on_cpu(&film.at(at(seconds)).unwrap());
            assert!(is_near(&format!("time-{name}-{seconds}"), &expected, &got), "{name} {seconds}");
            // The negative control: no frame passes for another.
            if let Some(before) = frames.last() {
                let difference = pixel_difference(&expected, before, PICTURE_THRESHOLD).unwrap();
                assert!(difference.over > 4.0 * PICTURE_OVER, "{name} {seconds}: {difference:?}");
            }
            frames.push(got);
        }
    }
}

#[test]
fn a_frame_alone_is_the_frame_of_the_film_and_the_loop_closes() {
    let Some(gpu) = gpu() else { return };
    let film = film(&[]);
    let first = film.at_without_heights(at(2.25)).unwrap();
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue, &first, FORMAT, &RendererOptions::default()).unwrap();
    let mut frame = |seconds: f64| {
        renderer.set_scene(&film.at_without_heights(at(seconds)).unwrap()).unwrap();
        draw_with(gpu, &mut renderer, [160, 110], FORMAT)
    };
    let frames = TIMES.map(&mut frame);
    for (seconds, in_film) in TIMES.into_iter().zip(&frames) {
        assert!(*in_film == draw(gpu, &film.at_without_heights(at(seconds)).unwrap(), FORMAT), "{seconds}");
        assert!(*in_film == draw(gpu, &film.at(at(seconds)).unwrap(), FORMAT), "{seconds}: heights made before");
        assert!(*in_film == frame(seconds + 4.0), "{seconds}: the next loop");
    }
}

#[test]
fn another_scene_is_refused_and_the_old_one_drawn_on() {
    let Some(gpu) = gpu() else { return };
    let load = |overrides: &[&str]| film(overrides).at(at(1.0)).unwrap();
    let scene = load(&[]);
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue, &scene, FORMAT, &RendererOptions::default()).unwrap();
    let before = draw_with(gpu, &mut renderer, [160, 110], FORMAT);
    for other in [
        &["shading.color_space=display"][..],
        &["shading.model=pbr"],
        &["image.samples=4"],
        &["objects.1.material=clouds"],
        &["objects.2.mesh=cube", "objects.2.material=clouds"],
    ] {
        let error = renderer.set_scene(&load(other)).unwrap_err();
        assert!(matches!(error, GpuError::Scene(_)), "{other:?}: {error}");
    }
    assert!(draw_with(gpu, &mut renderer, [160, 110], FORMAT) == before);
    // Whatever else changes is as in a renderer of its own.
    for other in [
        "objects.0.scale=0.7",
        "objects.1.mesh=torus",
        "objects.0.uv_repeat=3",
        "materials.clouds.height_scale=0.3",
        "materials.clouds.base_color=[1,0,0]",
        "materials.stones.layer_blend=mean",
        "materials.stones.filter=nearest",
        "materials.stones.relief.technique=displacement",
        "camera.vertical_fov=30",
        "shading.ambient=0.7",
    ] {
        let scene = load(&[other]);
        renderer.set_scene(&scene).unwrap();
        let moved = draw_with(gpu, &mut renderer, [160, 110], FORMAT);
        assert!(moved == draw(gpu, &scene, FORMAT) && moved != before, "{other}");
    }
}

/// Drifting mists over stones, of heights that the device makes, one of which grows out of nothing.
const MIST: &str = r#"
    [image]
    width = 160
    height = 110
    background = [0.4, 0.5, 0.7]
    [[lights]]
    kind = "directional"
    direction = [0.8, 0.3, -0.5]
    [camera]
    up = [0, 0, 1]
    target = [0, 0, 0.2]
    [materials.stones]
    from = "make:cobbles"
    height_scale = 0.1
    relief.shadow = "exact"
    [materials.fog]
    kind = "mist"
    height = "make:clouds"
    height_size = 128
    depth = 0.3
    mist = { density = 8, steps = 10 }
    [materials.veil]
    kind = "mist"
    height = "make:fog-bank"
    base_color = [1, 0.5, 0.2]
    layers = [{ velocity = [0.25, 0] }, { velocity = [0, -0.5] }]
    depth = 0.2
    mist = { density = 4, steps = 5 }
    [[objects]]
    mesh = "quad"
    material = "stones"
    [[objects]]
    mesh = "quad"
    material = "fog"
    translate = [0, 0, 0.3]
    [[objects]]
    mesh = "quad"
    material = "veil"
    translate = [0, 0, 0.6]
    [[animate]]
    key = "camera.position"
    keys = [{ time = 0, value = [0.2, -1.6, 1.6] }, { time = 4, value = [-0.5, -1.8, 0.4] }]
    [[animate]]
    key = "materials.fog.depth"
    keys = [{ time = 0, value = 0 }, { time = 1, value = 0.3 }]
    [[animate]]
    key = "materials.veil.depth"
    keys = [{ time = 0, value = 0 }, { time = 0.5, value = 0 }, { time = 4, value = 0.2 }]
    [[animate]]
    key = "materials.veil.mist.density"
    keys = [{ time = 0, value = 2 }, { time = 4, value = 6 }]
"#;

#[test]
fn mist_drifts_on_the_device_as_on_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let options = LoadOptions { make_size: 64, ..LoadOptions::default() };
    let film = AnimatedScene::parse(MIST, "mist.toml", Path::new(""), &options).unwrap();
    // At first no mist has depth, though surfaces ask what mist lets through.
    let first = film.at_without_heights(at(0.0)).unwrap();
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue, &first, FORMAT, &RendererOptions::default()).unwrap();
    assert_eq!(renderer.notes(), Vec::<String>::new());
    let mut before: Option<Grid<[u8; 3]>> = None;
    for seconds in [0.0, 0.4, 1.5, 4.0, 0.0] {
        let scene = film.at_without_heights(at(seconds)).unwrap();
        renderer.set_scene(&scene).unwrap();
        let got = draw_with(gpu, &mut renderer, [160, 110], FORMAT);
        assert!(got == draw(gpu, &scene, FORMAT), "{seconds}: a renderer of its own");
        let expected = on_cpu(&film.at(at(seconds)).unwrap());
        assert!(is_near(&format!("time-mist-{seconds}"), &expected, &got), "{seconds}");
        // The negative control.
        if let Some(before) = before.replace(got) {
            let difference = pixel_difference(&expected, &before, PICTURE_THRESHOLD).unwrap();
            assert!(difference.over > 4.0 * PICTURE_OVER, "{seconds}: {difference:?}");
        }
    }
}
