//! Scenes at a time: keyframes, moving maps, heights that change.

use std::path::Path;

use relievo_scene::{AnimatedScene, ChangingHeights, LightKind, LoadOptions, Scene, SceneError, SceneTime};

fn at(seconds: f64) -> SceneTime {
    SceneTime::from_seconds(seconds).unwrap()
}

fn animated(text: &str) -> Result<AnimatedScene, SceneError> {
    let options = LoadOptions { make_size: 16, ..LoadOptions::default() };
    AnimatedScene::parse(text, "scene.toml", Path::new("/nonexistent"), &options)
}

fn scene(text: &str, seconds: f64) -> Scene {
    animated(text).unwrap().at(at(seconds)).unwrap()
}

const OBJECT: &str = "[[objects]]\nmesh = \"quad\"\n";

fn wall(rest: &str) -> String {
    format!(
        "[materials.a]\nfrom = \"make:cobbles\"\n{OBJECT}[[lights]]\nkind = \"point\"\nposition = [0, 0, 1]\n{rest}"
    )
}

#[test]
fn cameras_lights_objects_and_materials_follow_their_keyframes() {
    let text = wall(
        r#"
        [[animate]]
        key = "camera.position"
        keys = [{ time = 0, value = [0, 0, 3] }, { time = 2, value = [2, 0, 3] }]
        [[animate]]
        key = "camera.vertical_fov"
        keys = [{ time = 1, value = 30 }]
        [[animate]]
        key = "lights.0.position"
        keys = [{ time = 0, value = [0, 0, 1] }, { time = 4, value = [4, 0, 1] }]
        interpolation = "smooth"
        [[animate]]
        key = "objects.0.rotate"
        loop = true
        keys = [{ time = 0, value = [0, 0, 0] }, { time = 4, value = [0, 0, 360] }]
        [[animate]]
        key = "materials.a.height_scale"
        keys = [{ time = 0, value = 0.1 }, { time = 2, value = 0.2 }]
        [[animate]]
        key = "materials.a.relief.min_layers"
        keys = [{ time = 0, value = 4 }, { time = 2, value = 8 }]
        [[animate]]
        key = "image.background"
        keys = [{ time = 0, value = [0, 0, 0] }, { time = 2, value = [1, 0, 0] }]
        "#,
    );
    let scene = |seconds| scene(&text, seconds);
    let one = scene(1.0);
    assert_eq!(one.camera.position.to_array(), [1.0, 0.0, 3.0]);
    assert_eq!((one.camera.vertical_fov, one.image.background), (30.0, [0.5, 0.0, 0.0]));
    assert_eq!(one.materials[0].relief.min_layers, 6.0);
    assert_eq!(one.materials[0].height, relievo_scene::HeightRange::Scale(0.15f64 as f32));
    let LightKind::Point { position } = one.lights[0].kind else { panic!() };
    assert!((position.x - 4.0 * (0.25f32.powi(2) * (3.0 - 0.5))).abs() < 1e-6, "a smooth step: {position}");
    let turned = one.objects[0].transform.transform_vector3(glam::Vec3::X);
    assert!((turned - glam::Vec3::Y).length() < 1e-6, "{turned}");
    assert_eq!(scene(5.0).objects[0].transform, one.objects[0].transform, "it goes round");
    assert_eq!(scene(9.0).camera.position.x, 2.0, "and the camera stays");
}

#[test]
fn a_scene_at_a_time_depends_on_the_time_alone_and_shares_what_stands_still() {
    let text = wall(
        "[time]\nloop = 4\n[[animate]]\nkey = \"camera.near\"\nkeys = [{ time = 0, value = 1 }, { time = 4, value = 2 }]\n",
    );
    let film = animated(&text).unwrap();
    assert!(film.is_animated() && film.length() == Some(at(4.0)));
    let (one, three, again) = (film.at(at(1.0)).unwrap(), film.at(at(3.0)).unwrap(), film.at(at(5.0)).unwrap());
    assert_eq!((one.camera.near, three.camera.near, again.camera.near), (1.25, 1.75, 1.25));
    assert_eq!(one.materials[0].maps.ids(), three.materials[0].maps.ids());
    assert!(std::sync::Arc::ptr_eq(&one.objects[0].mesh, &three.objects[0].mesh));
    // The loop closes to the last bit, and says that the track jumps there.
    let (first, last) = (film.at(at(0.0)).unwrap(), film.at(at(4.0)).unwrap());
    assert_eq!(first.camera, last.camera);
    assert!(
        first.notes.iter().any(|note| note.starts_with("camera.near has another value at the end")),
        "{:?}",
        first.notes
    );
    assert!(!animated(&wall("")).unwrap().is_animated());
}

#[test]
fn texture_coordinates_move_and_say_where_they_jump() {
    let text = |velocity: &str| {
        wall("[time]\nloop = 4\n").replace("from", &format!("uv_velocity = {velocity}\nuv_offset = [0.5, 0]\nfrom"))
    };
    let offset = |seconds| scene(&text("[0.25, -0.5]"), seconds).materials[0].uv.offset.to_array();
    assert_eq!((offset(0.0), offset(1.0), offset(4.0)), ([0.5, 0.0], [0.75, 0.5], [0.5, 0.0]));
    assert!(scene(&text("[0.25, -0.5]"), 0.0).notes.is_empty());
    let notes = scene(&text("[0.3, 0]"), 0.0).notes;
    assert!(notes[0].starts_with("material \"a\" moves by 1.2, 0 repeats in the scene's loop of 4 s"), "{notes:?}");
}

const CLOUDS: &str = "[materials.a]\nheight = \"make:clouds\"\nheight_size = 64\n";

#[test]
fn heights_of_a_recipe_change_and_close_with_the_scenes_loop() {
    let text = format!("{CLOUDS}{OBJECT}[time]\nloop = 6\n");
    let film = animated(&text).unwrap();
    let heights = |seconds: f64| film.at(at(seconds)).unwrap().materials[0].maps.height.clone().unwrap();
    let recipe = relievo_make::built_in("clouds").unwrap();
    assert_eq!(heights(0.0).grid().width(), 64);
    for seconds in [0.0, 1.5, 5.9] {
        let made = relievo_make::HeightRecipe::of(&recipe).heights(64, at(seconds).phase(at(6.0))).unwrap();
        assert!(heights(seconds) == made, "{seconds}");
        assert!(recipe.make_at(64, at(seconds).phase(at(6.0))).unwrap().height.unwrap() == made, "{seconds}");
    }
    assert!(heights(0.0) == heights(6.0) && heights(1.0) == heights(13.0) && heights(0.0) != heights(1.0));
    assert!(!film.at(at(1.0)).unwrap().notes.iter().any(|note| note.contains("material")));
    // For a device the heights are named, not made.
    let later = film.at_without_heights(at(1.5)).unwrap();
    let material = &later.materials[0];
    assert!(!material.heights_are_made && *material.maps.height.as_ref().unwrap() == heights(0.0));
    let Some(ChangingHeights::Recipe { phase, size: 64, .. }) = material.changing_heights else { panic!() };
    assert_eq!(phase, 0.25);
    // A period of its own, which does not fit, is said.
    let own = text.replace("height_size", "height_period = 4\nheight_size");
    let notes = scene(&own, 0.0).notes;
    let says = "material \"a\": its heights go round in 4 s, which is no part";
    assert!(notes.iter().any(|note| note.starts_with(says)), "{notes:?}");
    // All maps of a material, too.
    let all = format!("[materials.a]\nfrom = \"make:clouds\"\n{OBJECT}[time]\nloop = 6\n");
    let maps = |seconds: f64| scene(&all, seconds).materials[0].maps.clone();
    assert!(maps(0.0) == maps(6.0) && maps(0.0).normal != maps(1.0).normal);
}

#[test]
fn layers_blend_the_materials_height_map() {
    let text = format!(
        "[materials.a]\nfrom = \"make:cobbles\"\nlayer_blend = \"max\"\n[[materials.a.layers]]\nvelocity = [0.25, 0]\n\
         [[materials.a.layers]]\nvelocity = [-0.25, 0]\nrepeat = 2\nweight = 0.5\n{OBJECT}[time]\nloop = 4\n"
    );
    let film = animated(&text).unwrap();
    let heights = |seconds: f64| film.at(at(seconds)).unwrap().materials[0].maps.height.clone().unwrap();
    let still = relievo_make::make("cobbles", 16).unwrap().height.unwrap();
    let halves = |x: u32, y: u32| {
        0.5 * (still.grid().get((2 * x) % 16, (2 * y) % 16)
            + still.grid().get((2 * x + 1) % 16, (2 * y + 1) % 16)
            + still.grid().get((2 * x + 1) % 16, (2 * y) % 16)
            + still.grid().get((2 * x) % 16, (2 * y + 1) % 16))
            * 0.25
    };
    for (x, y) in [(0, 0), (5, 9), (15, 3)] {
        let expected = still.grid().get(x, y).max(halves(x, y));
        assert!((heights(0.0).grid().get(x, y) - expected).abs() < 1e-5);
    }
    assert!(heights(0.0) != heights(1.0) && heights(0.0) == heights(4.0));
    let notes = film.at(at(1.0)).unwrap().notes;
    assert!(notes.iter().any(|note| note.contains("its normal map does not follow the heights")), "{notes:?}");
}

#[test]
fn mistakes_name_their_line_and_what_to_do() {
    let track = |key: &str, keys: &str| format!("[[animate]]\nkey = \"{key}\"\nkeys = [{keys}]\n{}", wall(""));
    let good = "{ time = 0, value = 1 }, { time = 1, value = 2 }";
    for (text, says) in [
        (track("camera.fov", good), "scene.toml:2: unknown key \"fov\" in [camera]; did you mean \"vertical_fov\"?"),
        (track("camra.near", good), "scene.toml:2: key = \"camra.near\": the scene has no \"camra\""),
        (track("materials.b.height_scale", good), "the scene has no \"materials.b\""),
        (
            track("lights.1.intensity", good),
            "scene.toml:2: key = \"lights.1.intensity\": \"lights\" is a list of 1 and has no \"1\"",
        ),
        (track("materials.a.from", good), "is the text \"make:cobbles\": only numbers can be animated"),
        (track("lights.0", good), "only numbers can be animated"),
        (track("camera", good), "scene.toml:2: key in [[animate]] must be the path of a key"),
        (track("image.width", good), "width does not change in the course of a scene"),
        (track("time.loop", good), "does not change"),
        (track("camera.near", ""), "scene.toml:3: [[animate]] needs keys"),
        (
            track("camera.near", "{ time = nan, value = 1 }"),
            "scene.toml:3: time in [[animate.keys]] must be a number of seconds, of magnitude at most 1e6, found NaN",
        ),
        (track("camera.near", "{ time = 0, value = nan }"), "value in [[animate.keys]] must be a finite number"),
        (track("camera.near", "{ time = 0, value = inf }"), "found inf"),
        (track("camera.near", "{ time = 0, value = \"a\" }"), "found the text \"a\""),
        (track("camera.near", "{ time = 0, value = [] }"), "found a list of 0"),
        (track("camera.near", "{ time = 0 }"), "a keyframe needs a value"),
        (track("camera.near", "{ value = 0 }"), "a keyframe needs a time"),
        (
            track("camera.near", "{ time = 1, value = 1 }, { time = 1, value = 2 }"),
            "must follow each other in time, found 1 s after 1 s",
        ),
        (track("camera.near", "{ time = 2, value = 1 }, { time = 1, value = 2 }"), "found 1 s after 2 s"),
        (track("camera.near", "{ time = 0, value = 1 }, { time = 1, value = [2] }"), "as many numbers"),
        (
            track("camera.near", "{ time = 0, value = 1, tme = 2 }"),
            "unknown key \"tme\" in [[animate.keys]]; did you mean \"time\"?",
        ),
        // A value that is wrong at a later keyframe is found at once.
        (
            track("camera.near", "{ time = 0, value = 1 }, { time = 9, value = -2 }"),
            "scene.toml:2: near in [camera] must be a number above 0, found -2",
        ),
        (
            track("camera.position", "{ time = 0, value = [1, 2] }"),
            "position in [camera] must be 3 finite numbers, found a list of 2",
        ),
        (
            track("camera.near", good)
                .replace("keys =", "loop = true\nkeys =")
                .replace(", { time = 1, value = 2 }", ""),
            "scene.toml:3: a loop needs two keyframes or more in [[animate]]: with one its length is 0",
        ),
        (track("camera.near", good).replace("keys =", "interpolation = \"smoth\"\nkeys ="), "did you mean \"smooth\"?"),
        (
            format!(
                "{}{}",
                track("camera.position", "{ time = 0, value = [0, 0, 1] }"),
                "[[animate]]\nkey = \"camera.position.0\"\nkeys = [{ time = 0, value = 1 }]\n"
            ),
            "another [[animate]] sets \"camera.position\"",
        ),
        (
            format!("[time]\nloop = 0\n{}", wall("")),
            "scene.toml:2: loop in [time] must be a number of seconds, 0.001 to 1e6; a loop of length 0 has no frames, found 0",
        ),
        (format!("[time]\nloop = nan\n{}", wall("")), "found NaN"),
        (format!("[time]\nlop = 1\n{}", wall("")), "did you mean \"loop\"?"),
        (
            wall("").replace("from", "uv_velocity = [nan, 0]\nfrom"),
            "uv_velocity in [materials.a] must be 2 numbers of magnitude at most 1000",
        ),
        (wall("").replace("from", "height_size = 9\nfrom"), "height_size is the size of heights that are made"),
        (wall("").replace("from", "height_period = 9\nfrom"), "height_period is the length of a recipe's loop"),
        (wall("").replace("from", "layer_blend = \"max\"\nfrom"), "but there are none"),
        (
            wall("").replace("from", "layers = [{ repeat = 1.5 }]\nfrom"),
            "repeat in [[materials.NAME.layers]] must be a whole number",
        ),
        (wall("").replace("from", "layers = [{ weight = -1 }]\nfrom"), "weight in [[materials.NAME.layers]]"),
        (format!("{CLOUDS}layers = [{{}}]\n{OBJECT}"), "layers blend maps that stand still"),
        (
            format!("[materials.a]\nlayers = [{{}}]\n{OBJECT}"),
            "this layer has no height map, and neither has its material",
        ),
        (CLOUDS.replace("clouds", "clods") + OBJECT, "height = \"make:clods\" is not known"),
        (CLOUDS.replace("clouds", "clouds\"\nwhite = \"deep") + OBJECT, "height is a recipe; leave it out"),
        (
            CLOUDS.replace("make:clouds", "no.toml") + OBJECT,
            "height in [materials.a]: /nonexistent/no.toml: there is no such file",
        ),
    ] {
        let error = animated(&text).and_then(|film| film.at(at(0.0))).map(drop);
        let error = error.expect_err(&text).to_string();
        assert!(error.contains(says), "{text}\n{error}\nexpected: {says}");
    }
}

#[test]
fn a_recipe_file_is_read_beside_the_scene_and_its_mistakes_name_their_line() {
    let folder = tempfile::tempdir().unwrap();
    let recipe = relievo_make::recipe_text("clouds").unwrap();
    std::fs::write(folder.path().join("sky.toml"), recipe).unwrap();
    std::fs::write(folder.path().join("bad.toml"), recipe.replace("time_cells = 3", "time_cells = 1")).unwrap();
    let load = |file: &str| {
        let text = format!("[materials.a]\nheight = \"{file}\"\n{OBJECT}");
        let options = LoadOptions { make_size: 16, time: at(2.0), ..LoadOptions::default() };
        Scene::parse(&text, "s.toml", folder.path(), &options)
    };
    let made = relievo_make::HeightRecipe::of(&relievo_make::built_in("clouds").unwrap()).heights(16, 0.25).unwrap();
    assert!(load("sky.toml").unwrap().materials[0].maps.height == Some(made), "a quarter of the recipe's 8 s");
    let error = load("bad.toml").unwrap_err().to_string();
    assert!(
        error.contains("bad.toml:")
            && error.contains("time_cells must be 0 (the noise stands still) or 2 to 4096, found 1"),
        "{error}"
    );
}

#[test]
fn a_key_that_is_set_is_animated_no_more() {
    let text = wall(
        "[[animate]]\nkey = \"camera.position\"\nkeys = [{ time = 0, value = [0, 0, 3] }, { time = 1, value = [1, 0, 3] }]\n\
         [[animate]]\nkey = \"camera.near\"\nkeys = [{ time = 0, value = 1 }, { time = 1, value = 2 }]\n",
    );
    let overrides = vec!["camera.position=[5,0,3]".parse().unwrap()];
    let options = LoadOptions { make_size: 16, overrides, time: at(1.0), ..LoadOptions::default() };
    let camera = Scene::parse(&text, "s.toml", Path::new(""), &options).unwrap().camera;
    assert_eq!((camera.position.x, camera.near), (5.0, 2.0));
}

#[test]
fn too_many_keyframes_are_refused() {
    let keys: Vec<String> = (0..10_001).map(|k| format!("{{ time = {k}, value = 1 }}")).collect();
    let text = format!("[[animate]]\nkey = \"camera.near\"\nkeys = [{}]\n{}", keys.join(", "), wall(""));
    assert!(animated(&text).err().unwrap().to_string().contains("more than 10000 keyframes"));
}
