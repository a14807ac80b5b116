//! Frames of an animation.

use std::path::Path;

use relievo_cpu::{RenderOptions, Renderer};
use relievo_map::Grid;
use relievo_scene::{AnimatedScene, LoadOptions, Scene, SceneTime};

const FILM: &str = r#"
    [image]
    width = 48
    height = 32
    [time]
    loop = 4
    [[lights]]
    kind = "directional"
    direction = [-0.5, -1, -0.4]
    [camera]
    position = [0, 1, 2]
    [materials.clouds]
    height = "make:clouds"
    height_size = 64
    uv_velocity = [0.25, 0]
    relief.shadow = "exact"
    [materials.stones]
    from = "make:cobbles"
    layers = [{ velocity = [0.25, 0] }, { velocity = [0, -0.5] }]
    [[objects]]
    mesh = "plane"
    material = "clouds"
    [[objects]]
    mesh = "cube"
    material = "stones"
    scale = 0.3
    [[animate]]
    key = "objects.1.rotate"
    loop = true
    keys = [{ time = 0, value = [0, 0, 0] }, { time = 4, value = [0, 360, 0] }]
    [[animate]]
    key = "shading.ambient"
    keys = [{ time = 0, value = 0.1 }, { time = 2, value = 0.5 }, { time = 4, value = 0.1 }]
"#;

fn film() -> AnimatedScene {
    let options = LoadOptions { make_size: 32, ..LoadOptions::default() };
    AnimatedScene::parse(FILM, "film.toml", Path::new(""), &options).unwrap()
}

fn at(seconds: f64) -> SceneTime {
    SceneTime::from_seconds(seconds).unwrap()
}

fn draw(renderer: &Renderer, threads: usize) -> Grid<[u8; 3]> {
    renderer.render(&RenderOptions { threads: Some(threads), ..RenderOptions::default() }).unwrap().pixels
}

#[test]
fn a_frame_alone_is_the_frame_of_the_film_with_any_number_of_threads() {
    let shared = film();
    let first = Renderer::new(&shared.at(at(0.0)).unwrap()).unwrap();
    let mut known = first.for_scene(&shared.at(at(0.0)).unwrap()).unwrap();
    let mut frames = Vec::new();
    for seconds in [0.0, 1.0, 1.5, 3.9, 4.0, 5.5] {
        let scene = shared.at(at(seconds)).unwrap();
        known = known.for_scene(&scene).unwrap();
        let in_film = draw(&known, 3);
        let alone = draw(&Renderer::new(&film().at(at(seconds)).unwrap()).unwrap(), 1);
        assert!(in_film == alone, "{seconds}");
        assert!(draw(&first.for_scene(&scene).unwrap(), 2) == alone, "{seconds}: after another frame");
        // Heights that are left to the renderer are made by it.
        let later = shared.at_without_heights(at(seconds)).unwrap();
        assert!(draw(&known.for_scene(&later).unwrap(), 1) == alone, "{seconds}: heights made later");
        frames.push(in_film);
    }
    assert!(frames[0] == frames[4] && frames[2] == frames[5], "the loop closes");
    for (a, b) in [(0, 1), (1, 2), (2, 3), (3, 0)] {
        assert!(frames[a] != frames[b], "{a} {b}: the picture changes");
    }
}

#[test]
fn a_scene_with_one_other_key_is_drawn_anew() {
    // The negative control of sharing: whatever changes is seen.
    let load = |change: &str| {
        let overrides = if change.is_empty() { Vec::new() } else { vec![change.parse().unwrap()] };
        let options = LoadOptions { make_size: 32, overrides, ..LoadOptions::default() };
        AnimatedScene::parse(FILM, "film.toml", Path::new(""), &options).unwrap().at(at(1.0)).unwrap()
    };
    let first = Renderer::new(&load("")).unwrap();
    let plain = draw(&first, 1);
    for change in [
        "objects.0.scale=0.7",
        "objects.1.translate=[0.2,0,0]",
        "objects.0.uv_repeat=3",
        "objects.1.mesh=torus",
        "materials.clouds.height_scale=0.3",
        "materials.clouds.uv_offset=[0.1,0]",
        "materials.clouds.base_color=[1,0,0]",
        "materials.stones.wrap=mirror",
        "materials.stones.filter=nearest",
        "materials.stones.relief.technique=displacement",
        "lights.0.color=[1,0,0]",
        "camera.vertical_fov=30",
        "shading.color_space=display",
        "image.background=[1,0,0]",
    ] {
        let scene: Scene = load(change);
        let shared = draw(&first.for_scene(&scene).unwrap(), 1);
        assert!(shared == draw(&Renderer::new(&scene).unwrap(), 1), "{change}");
        // Mirrored whole tiles look alike from afar.
        assert!(shared != plain || change.contains("mirror"), "{change}");
    }
}

/// Two drifting mists, of heights that change, that an eye passes, and that grow out of nothing.
const MIST: &str = r#"
    [image]
    width = 40
    height = 30
    background = [0.4, 0.5, 0.7]
    [[lights]]
    kind = "directional"
    direction = [0.8, 0.3, -0.5]
    [camera]
    up = [0, 0, 1]
    target = [0, 0, 0.3]
    [materials.ground]
    [materials.fog]
    kind = "mist"
    height = "make:clouds"
    height_size = 32
    depth = 0.3
    mist = { density = 8 }
    [materials.veil]
    kind = "mist"
    from = "make:fog-bank"
    base_color = [1, 0.5, 0.2]
    layers = [{ velocity = [0.25, 0] }, { velocity = [0, -0.5] }]
    depth = 0.2
    mist = { density = 4 }
    [[objects]]
    mesh = "quad"
    material = "ground"
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
    keys = [{ time = 0, value = [0.2, -1, 2.5] }, { time = 4, value = [0.2, -1, -1.5] }]
    [[animate]]
    key = "materials.fog.depth"
    keys = [{ time = 0, value = 0 }, { time = 1, value = 0.3 }]
    [[animate]]
    key = "materials.veil.mist.density"
    keys = [{ time = 0, value = 4 }, { time = 4, value = 9 }]
"#;

#[test]
fn mist_drifts_and_is_sorted_for_the_camera_of_each_frame() {
    let options = LoadOptions { make_size: 32, ..LoadOptions::default() };
    let film = AnimatedScene::parse(MIST, "mist.toml", Path::new(""), &options).unwrap();
    let mut known = Renderer::new(&film.at(at(0.0)).unwrap()).unwrap();
    let mut before = None;
    for seconds in [0.0, 0.5, 1.0, 3.0, 4.0] {
        let scene = film.at_without_heights(at(seconds)).unwrap();
        known = known.for_scene(&scene).unwrap();
        let in_film = draw(&known, 2);
        assert!(in_film == draw(&Renderer::new(&film.at(at(seconds)).unwrap()).unwrap(), 1), "{seconds}");
        assert!(before.replace(in_film.clone()).is_none_or(|before| before != in_film), "{seconds}: it moves");
    }
    // Another camera alone, from which the mists hide each other the other way round.
    let mut turned = film.at(at(4.0)).unwrap();
    turned.camera = film.at(at(0.5)).unwrap().camera;
    assert!(draw(&known.for_scene(&turned).unwrap(), 2) == draw(&Renderer::new(&turned).unwrap(), 2));
}
