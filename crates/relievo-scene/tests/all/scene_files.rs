use std::path::{Path, PathBuf};

use relievo_scene::LoadOptions;
use relievo_scene::{Scene, SceneError};

pub(crate) fn parse(text: &str) -> Result<Scene, SceneError> {
    Scene::parse(
        text,
        "scene.toml",
        Path::new("/nonexistent"),
        &LoadOptions { make_size: 16, ..LoadOptions::default() },
    )
}

/// The folder of pictures and scenes beside the checkout, if it is there.
fn shared() -> Option<PathBuf> {
    let shared = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    shared.join("reference").is_dir().then_some(shared)
}

#[test]
fn every_reference_scene_loads() {
    let Some(shared) = shared() else {
        eprintln!("skipped: there is no folder of reference scenes beside the checkout");
        return;
    };
    let mut loaded = 0;
    for entry in shared.join("reference").read_dir().unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            let scene = Scene::load(&path, &LoadOptions::default()).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!((scene.image.width, scene.image.height), (480, 360));
            assert_eq!((scene.lights.len(), scene.materials.len(), scene.objects.len()), (1, 1, 1));
            let maps = &scene.materials[0].maps;
            assert!(maps.base_color.is_some() && maps.normal.is_some() && maps.height.is_some());
            assert!(path.file_stem().unwrap().to_str().unwrap().contains(scene.materials[0].relief.technique.name()));
            loaded += 1;
        }
    }
    assert!(loaded >= 22, "{loaded}");
}

/// A scene that loads without files; tests change single lines of it.
pub(crate) const GOOD: &str = r#"[image]
width = 64
height = 48
background = [0, 0.5, 1]
samples = 4
[camera]
position = [0, 1, 3]
target = [0, 0, 0]
up = [0, 1, 0]
vertical_fov = 30
near = 0.1
[[lights]]
kind = "point"
position = [1, 1, 1]
color = [1, 0.5, 0]
intensity = 2
radius = 0.1
[[lights]]
kind = "directional"
direction = [0, -2, 0]
[[lights]]
kind = "spot"
position = [0, 3, 0]
direction = [0, -1, 0]
outer_angle = 12
[shading]
model = "pbr"
color_space = "linear"
ambient = 0.2
specular = 0.3
shininess = 64
[materials.wall]
from = "make:brick-wall"
base_color = [0.5, 0.5, 0.5]
roughness = 0.5
midlevel = 0.5
filter = "trilinear"
wrap = "mirror"
[materials.wall.relief]
technique = "occlusion"
offset_limiting = true
min_layers = 10
max_layers = 40.5
refine_steps = 6
shadow = "soft"
edge = "clamp"
grid = 50
lod = true
write_depth = true
[materials.plain]
metallic = 1
depth = 0.05
[[objects]]
mesh = "quad"
material = "wall"
translate = [1, 2, 3]
rotate = [0, 90, 0]
scale = 2
uv_repeat = [2, 3]
[[objects]]
mesh = "sphere"
material = "plain"
scale = [1, -1, 1]
uv_repeat = 4
"#;

/// The error of [`GOOD`] with one line replaced (or, for an empty one, put at the end).
fn error_with(line: &str, replacement: &str) -> String {
    let text = if line.is_empty() {
        format!("{GOOD}{replacement}\n")
    } else {
        assert_eq!(GOOD.lines().filter(|known| *known == line).count(), 1, "{line} must be there once");
        GOOD.lines()
            .map(|known| if known == line { replacement } else { known })
            .map(|line| format!("{line}\n"))
            .collect()
    };
    match parse(&text) {
        Ok(_) => format!("no error for: {replacement}"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn every_key_arrives_in_the_scene() {
    use glam::{Vec2, Vec3};
    use relievo_scene::{ColorSpace, Edge, Filter, HeightRange, LightKind, ShadingModel};
    let scene = parse(GOOD).unwrap();
    assert_eq!((scene.image.width, scene.image.height, scene.image.samples), (64, 48, 4));
    assert_eq!(scene.image.background, [0.0, 0.5, 1.0]);
    assert_eq!((scene.camera.position, scene.camera.vertical_fov), (Vec3::new(0.0, 1.0, 3.0), 30.0));
    assert_eq!(scene.camera.near, 0.1);
    let [point, sun, spot] = scene.lights[..] else { panic!() };
    assert_eq!(point.kind, LightKind::Point { position: Vec3::ONE });
    assert_eq!((point.color, point.intensity, point.radius), ([1.0, 0.5, 0.0], 2.0, 0.1));
    assert_eq!(sun.kind, LightKind::Directional { direction: Vec3::NEG_Y });
    assert_eq!((sun.color, sun.intensity, sun.radius), ([1.0; 3], 1.0, 0.0));
    let LightKind::Spot { inner_angle, outer_angle, .. } = spot.kind else { panic!() };
    assert_eq!((inner_angle, outer_angle), (8.0, 12.0));
    let shading = scene.shading;
    assert_eq!((shading.model, shading.color_space), (ShadingModel::Pbr, ColorSpace::Linear));
    assert_eq!((shading.ambient, shading.specular, shading.shininess), (0.2, 0.3, 64.0));
    let [wall, plain] = &scene.materials[..] else { panic!() };
    assert_eq!((wall.name.as_str(), plain.name.as_str()), ("wall", "plain"));
    assert_eq!(wall.maps.height.as_ref().unwrap().grid().width(), 16);
    assert_eq!(wall.height, HeightRange::Scale(relievo_make::height_scale("brick-wall").unwrap()));
    assert_eq!((wall.base_color, wall.roughness, wall.midlevel), ([0.5; 3], 0.5, 0.5));
    assert_eq!((wall.filter, wall.wrap), (Filter::Trilinear, relievo_map::Wrap::Mirror));
    let relief = wall.relief;
    assert_eq!(relief.technique.name(), "occlusion");
    assert_eq!((relief.min_layers, relief.max_layers, relief.refine_steps), (10.0, 40.5, Some(6)));
    assert_eq!((relief.shadow.name(), relief.edge), ("soft", Edge::Clamp));
    assert_eq!((relief.grid, relief.lod, relief.offset_limiting, relief.write_depth), (50, true, true, Some(true)));
    assert_eq!(relief.vertices_per_texel, None);
    assert_eq!((plain.metallic, plain.height), (1.0, HeightRange::Depth(0.05)));
    let [quad, sphere] = &scene.objects[..] else { panic!() };
    assert_eq!((quad.material, quad.uv_repeat, quad.mesh.triangles.len()), (0, Vec2::new(2.0, 3.0), 2));
    assert_eq!(quad.transform.transform_point3(Vec3::X), Vec3::new(1.0, 2.0, 1.0));
    assert_eq!((sphere.material, sphere.uv_repeat), (1, Vec2::splat(4.0)));
    assert_eq!(scene.notes, Vec::<String>::new());
}

#[test]
fn a_scene_may_be_as_small_as_one_object_and_one_material() {
    let scene = parse("[materials.m]\n[[objects]]\nmesh = \"quad\"\n").unwrap();
    assert_eq!(scene.objects[0].material, 0);
    assert!(scene.notes.iter().any(|note| note.contains("no [[lights]]")), "{:?}", scene.notes);
}

#[test]
fn a_technique_without_heights_and_what_a_light_does_not_use_are_noted() {
    let text = "[materials.m.relief]\ntechnique = \"steep\"\n[[lights]]\nkind = \"directional\"\ndirection = [0, 0, -1]\n\
                position = [0, 0, 1]\n[[objects]]\nmesh = \"quad\"\n";
    let scene = parse(text).unwrap();
    let expected = [
        "lights.0: position means nothing for a directional light",
        "material \"m\" has no height map for \"steep\": it is flat",
    ];
    assert_eq!(scene.notes, expected);
}

#[test]
fn every_documented_key_is_read() {
    let text = format!(
        "{GOOD}\n[[materials.wall.layers]]\n[materials.fog]\nkind = \"mist\"\n[[animate]]\nkey = \"camera.near\"\n\
         keys = [{{ time = 0, value = 1 }}]\n"
    );
    for key in relievo_scene::SCENE_KEYS.iter().filter(|key| key.table.starts_with('[')) {
        let table = match key.table {
            "[image]" => "image",
            "[camera]" => "camera",
            "[[lights]]" => "lights.2",
            "[shading]" => "shading",
            "[materials.NAME]" => "materials.wall",
            "[materials.NAME.relief]" => "materials.wall.relief",
            "[materials.NAME.mist]" => "materials.fog.mist",
            "[[materials.NAME.layers]]" => "materials.wall.layers.0",
            "[[objects]]" => "objects.0",
            "[time]" => "time",
            "[[animate]]" => "animate.0",
            "[[animate.keys]]" => "animate.0.keys.0",
            other => panic!("{other}"),
        };
        // Nothing takes a date: whoever reads the key must say so.
        let change = format!("{table}.{}=1979-05-27", key.key);
        let options = LoadOptions { overrides: vec![change.parse().unwrap()], make_size: 4, ..LoadOptions::default() };
        let error =
            Scene::parse(&text, "scene.toml", Path::new(""), &options).map(|_| ()).expect_err(&change).to_string();
        assert!(error.starts_with(&format!("--set {change}: {} in [", key.key)), "{error}");
    }
}

#[test]
fn layers_given_alone_push_the_other_bound() {
    let layers = |text: &str| {
        let text = format!("[materials.m.relief]\n{text}\n[[objects]]\nmesh = \"quad\"\n");
        let relief = parse(&text).unwrap().materials[0].relief;
        (relief.min_layers, relief.max_layers)
    };
    assert_eq!(layers("max_layers = 4"), (4.0, 4.0));
    assert_eq!(layers("min_layers = 64"), (64.0, 64.0));
    assert_eq!(layers("min_layers = 10"), (10.0, 32.0));
}

#[test]
fn every_mistake_names_its_line_and_what_to_do() {
    let table: &[(&str, &str, &str)] = &[
        // Unknown keys, with the nearest one.
        ("width = 64", "widht = 64", "scene.toml:2: unknown key \"widht\" in [image]; did you mean \"width\"?"),
        ("near = 0.1", "far = 0.1", "scene.toml:11: unknown key \"far\" in [camera]; did you mean \"near\"?"),
        (
            "depth = 0.05",
            "heigth = \"a.png\"",
            "scene.toml:52: unknown key \"heigth\" in [materials.plain]; did you mean \"height\"?",
        ),
        (
            "shadow = \"soft\"",
            "shadows = \"soft\"",
            "scene.toml:45: unknown key \"shadows\" in [materials.wall.relief]; did you mean \"shadow\"?",
        ),
        (
            "intensity = 2",
            "colour = [1, 1, 1]",
            "scene.toml:16: unknown key \"colour\" in [[lights]]; did you mean \"color\"?",
        ),
        ("", "size = 1", "scene.toml:65: unknown key \"size\" in [[objects]]"),
        ("[shading]", "[shadng]", "scene.toml:26: unknown key \"shadng\" in the scene file; did you mean \"shading\"?"),
        // Types, ranges and counts.
        (
            "width = 64",
            "width = \"64\"",
            "scene.toml:2: width in [image] must be a whole number from 1 to 16384, found the text \"64\"",
        ),
        ("width = 64", "width = 0", "scene.toml:2: width in [image] must be a whole number from 1 to 16384, found 0"),
        (
            "width = 64",
            "width = 64.5",
            "scene.toml:2: width in [image] must be a whole number from 1 to 16384, found 64.5",
        ),
        (
            "height = 48",
            "height = 16385",
            "scene.toml:3: height in [image] must be a whole number from 1 to 16384, found 16385",
        ),
        (
            "background = [0, 0.5, 1]",
            "background = [0, 0.5]",
            "scene.toml:4: background in [image] must be 3 numbers from 0 to 1, found a list of 2",
        ),
        (
            "background = [0, 0.5, 1]",
            "background = [0, 0.5, 2]",
            "scene.toml:4: background in [image] must be 3 numbers from 0 to 1, found 2 in [0, 0.5, 2]",
        ),
        (
            "samples = 4",
            "samples = 0",
            "scene.toml:5: samples in [image] must be a whole number from 1 to 4096, found 0",
        ),
        (
            "samples = 4",
            "samples = -1",
            "scene.toml:5: samples in [image] must be a whole number from 1 to 4096, found -1",
        ),
        (
            "vertical_fov = 30",
            "vertical_fov = 180",
            "scene.toml:10: vertical_fov in [camera] must be a number above 0 and below 180 (degrees), found 180",
        ),
        (
            "vertical_fov = 30",
            "vertical_fov = nan",
            "scene.toml:10: vertical_fov in [camera] must be a number above 0 and below 180 (degrees), found NaN",
        ),
        ("near = 0.1", "near = 0", "scene.toml:11: near in [camera] must be a number above 0, found 0"),
        (
            "near = 0.1",
            "near = inf",
            "scene.toml:11: near in [camera] must be a number above 0, of magnitude at most 1e9, found inf",
        ),
        (
            "position = [0, 1, 3]",
            "position = [0, 1, nan]",
            "scene.toml:7: position in [camera] must be 3 finite numbers, found NaN in [0, 1, NaN]",
        ),
        (
            "position = [0, 1, 3]",
            "position = [0, 1e300, 3]",
            "scene.toml:7: position in [camera] must be 3 finite numbers, of magnitude at most 1e9, found 1e300 in [0, 1e300, 3]",
        ),
        (
            "position = [0, 1, 3]",
            "position = 3",
            "scene.toml:7: position in [camera] must be 3 finite numbers, found 3",
        ),
        (
            "intensity = 2",
            "intensity = -2",
            "scene.toml:16: intensity in [[lights]] must be a number, 0 or more, found -2",
        ),
        ("ambient = 0.2", "ambient = -1", "scene.toml:29: ambient in [shading] must be a number, 0 or more, found -1"),
        ("shininess = 64", "shininess = 0", "scene.toml:31: shininess in [shading] must be a number above 0, found 0"),
        (
            "base_color = [0.5, 0.5, 0.5]",
            "base_color = 0.5",
            "scene.toml:34: base_color in [materials.wall] must be an image file or 3 numbers from 0 to 1, found 0.5",
        ),
        (
            "roughness = 0.5",
            "roughness = 2",
            "scene.toml:35: roughness in [materials.wall] must be an image file or a number from 0 to 1, found 2",
        ),
        (
            "midlevel = 0.5",
            "midlevel = 1.5",
            "scene.toml:36: midlevel in [materials.wall] must be a number from 0 to 1, found 1.5",
        ),
        (
            "depth = 0.05",
            "depth = -1",
            "scene.toml:52: depth in [materials.plain] must be a number, 0 or more (object units), found -1",
        ),
        (
            "min_layers = 10",
            "min_layers = 0.5",
            "scene.toml:42: min_layers in [materials.wall.relief] must be a number from 1 to 4096, found 0.5",
        ),
        (
            "min_layers = 10",
            "min_layers = 41",
            "scene.toml:42: min_layers (41) in [materials.wall.relief] must be at most max_layers (40.5)",
        ),
        (
            "refine_steps = 6",
            "refine_steps = 65",
            "scene.toml:44: refine_steps in [materials.wall.relief] must be a whole number from 0 to 64, found 65",
        ),
        (
            "grid = 50",
            "grid = 1",
            "scene.toml:47: grid in [materials.wall.relief] must be a whole number from 2 to 8192, found 1",
        ),
        ("lod = true", "lod = 1", "scene.toml:48: lod in [materials.wall.relief] must be true or false, found 1"),
        (
            "scale = 2",
            "scale = 0",
            "scene.toml:58: scale in [[objects]] must be a number or 3 numbers, each of magnitude 1e-9 to 1e9, found 0",
        ),
        (
            "scale = [1, -1, 1]",
            "scale = [1, 0, 1]",
            "scene.toml:63: scale in [[objects]] must be a number or 3 numbers, each of magnitude 1e-9 to 1e9, found 0",
        ),
        (
            "uv_repeat = 4",
            "uv_repeat = 0",
            "scene.toml:64: uv_repeat in [[objects]] must be a number or 2 numbers above 0, found 0",
        ),
        (
            "uv_repeat = 4",
            "uv_repeat = 1e30",
            "scene.toml:64: uv_repeat in [[objects]] must be a number or 2 numbers above 0, of magnitude at most 1e9, found 1e30",
        ),
        (
            "uv_repeat = [2, 3]",
            "uv_repeat = [2, 3, 4]",
            "scene.toml:59: uv_repeat in [[objects]] must be a number or 2 numbers above 0, found a list of 3",
        ),
        (
            "near = 0.1",
            "near = 1e30",
            "scene.toml:11: near in [camera] must be a number above 0, of magnitude at most 1e9, found 1e30",
        ),
        (
            "near = 0.1",
            "near = 1e-60",
            "scene.toml:11: near in [camera] must be a number above 0, of magnitude at least 1.1754944e-38, found 1e-60",
        ),
        (
            "scale = 2",
            "scale = 1e-30",
            "scene.toml:58: scale in [[objects]] must be a number or 3 numbers, each of magnitude 1e-9 to 1e9, found 1e-30",
        ),
        // Names.
        (
            "technique = \"occlusion\"",
            "technique = \"oclusion\"",
            "scene.toml:40: technique = \"oclusion\" is not known; expected one of none, normal, basic, offset-limiting, unity-offset, steep, binary, relief, occlusion, contact, cone, exact, displacement; did you mean \"occlusion\"?",
        ),
        (
            "technique = \"occlusion\"",
            "technique = \"cone\"\ncones = \"relaxt\"",
            "scene.toml:41: cones = \"relaxt\" is not known; expected one of relaxed, conservative; did you mean \"relaxed\"?",
        ),
        (
            "edge = \"clamp\"",
            "edge = \"clib\"",
            "scene.toml:46: edge = \"clib\" is not known; expected one of clip, wrap, clamp, silhouette; did you mean \"clip\"?",
        ),
        (
            "shadow = \"soft\"",
            "shadow = \"sotf\"",
            "scene.toml:45: shadow = \"sotf\" is not known; expected one of none, hard, soft, exact; did you mean \"soft\"?",
        ),
        (
            "model = \"pbr\"",
            "model = \"phong\"",
            "scene.toml:27: model = \"phong\" is not known; expected one of blinn-phong, pbr",
        ),
        (
            "filter = \"trilinear\"",
            "filter = \"cubic\"",
            "scene.toml:37: filter = \"cubic\" is not known; expected one of linear, trilinear",
        ),
        (
            "wrap = \"mirror\"",
            "wrap = \"tile\"",
            "scene.toml:38: wrap = \"tile\" is not known; expected one of repeat, clamp, mirror",
        ),
        (
            "kind = \"spot\"",
            "kind = \"area\"",
            "scene.toml:22: kind = \"area\" is not known; expected one of point, directional, spot",
        ),
        (
            "mesh = \"sphere\"",
            "mesh = \"sphre\"",
            "scene.toml:61: mesh = \"sphre\" is not known; expected one of quad, plane, cube, sphere, cylinder, torus, or a .glb, .gltf or .obj file; did you mean \"sphere\"?",
        ),
        (
            "material = \"plain\"",
            "material = \"plane\"",
            "scene.toml:62: material = \"plane\" is not in the scene (wall, plain); did you mean \"plain\"?",
        ),
        (
            "from = \"make:brick-wall\"",
            "from = \"make:brick\"",
            "scene.toml:33: from = \"make:brick\" is not known; expected make: and one of brick-wall, toy-box",
        ),
        // Things that belong together.
        (
            "position = [0, 1, 3]",
            "position = [0, 0, 0]",
            "scene.toml:7: [camera] position and target are the same point; move one of them",
        ),
        ("up = [0, 1, 0]", "up = [0, 0, 0]", "scene.toml:9: up in [camera] has no length"),
        ("up = [0, 1, 0]", "up = [0, 2, 6]", "scene.toml:9: up in [camera] lies along the line of sight"),
        ("kind = \"directional\"", "", "scene.toml:18: [[lights]] needs a kind"),
        ("direction = [0, -2, 0]", "", "scene.toml:18: a directional light needs a direction"),
        ("direction = [0, -2, 0]", "direction = [0, 0, 0]", "scene.toml:20: direction in [[lights]] has no length"),
        ("position = [0, 3, 0]", "", "scene.toml:21: a spot light needs a position"),
        (
            "outer_angle = 12",
            "outer_angle = 12\ninner_angle = 12",
            "scene.toml:26: inner_angle (12) in [[lights]] must be below outer_angle (12)",
        ),
        (
            "depth = 0.05",
            "depth = 0.05\nheight_scale = 0.1",
            "scene.toml:52: [materials.plain] has both height_scale and depth",
        ),
        (
            "depth = 0.05",
            "normal_y = \"down\"",
            "scene.toml:52: normal_y in [materials.plain] says how the file under \"normal\" is to be read, but there is none",
        ),
        (
            "wrap = \"mirror\"",
            "white = \"deep\"",
            "scene.toml:38: white in [materials.wall] says how the file under \"height\" is to be read, but there is none",
        ),
        ("material = \"plain\"", "", "scene.toml:60: this object needs a material; name one of wall, plain"),
        ("mesh = \"quad\"", "", "scene.toml:53: this object needs a mesh"),
        // Shapes of tables.
        (
            "[camera]",
            "[[camera]]",
            "scene.toml:6: camera in the scene file must be a table, [camera], found a list of 1",
        ),
        // Files.
        (
            "depth = 0.05",
            "height = \"no.png\"",
            "scene.toml:52: height in [materials.plain]: /nonexistent/no.png: there is no such file",
        ),
        ("depth = 0.05", "from = \"no\"", "scene.toml:52: from in [materials.plain]: /nonexistent/no: "),
        (
            "depth = 0.05",
            "ao = \"\"",
            "scene.toml:52: ao in [materials.plain] must be the name of an image file, found the text \"\"",
        ),
        ("mesh = \"sphere\"", "mesh = \"no.glb\"", "scene.toml:61: mesh: /nonexistent/no.glb: cannot read it: "),
        (
            "shininess = 64",
            "environment = \"no.exr\"",
            "scene.toml:31: environment in [shading]: /nonexistent/no.exr: there is no such file",
        ),
        // Not TOML.
        ("near = 0.1", "near = ", "scene.toml:11: this is not valid TOML: "),
        ("near = 0.1", "near = 0.1\nnear = 0.2", "scene.toml:12: this is not valid TOML: duplicate key"),
        ("width = 64", "width = 99999999999999999999", "scene.toml:2: the number 99999999999999999999 is too large"),
    ];
    let mut wrong = String::new();
    for (line, replacement, expected) in table {
        let error = error_with(line, replacement);
        if !error.starts_with(expected) {
            wrong += &format!("{replacement}\n  expected: {expected}\n  found:    {error}\n");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn whole_scenes_that_are_wrong_say_so() {
    let table = [
        ("", "scene.toml: the scene has no [[objects]]"),
        ("objects = []", "scene.toml:1: the scene has no [[objects]]"),
        (
            "[objects]\nmesh = \"quad\"",
            "scene.toml:1: objects in the scene file must be a list of tables; write [[objects]] with two brackets, found a table",
        ),
        ("\n[lights]\n[[objects]]\nmesh = \"quad\"", "scene.toml:2: lights in the scene file must be a list of tables"),
        ("objects = [1]", "scene.toml:1: objects in the scene file must be a list of tables"),
        ("[[objects]]\nmesh = \"quad\"", "scene.toml:1: this object needs a material, and the scene has none"),
        (
            "[[objects]]\nmesh = \"quad\"\nmaterial = \"m\"",
            "scene.toml:3: material = \"m\" is not in the scene (there are none)",
        ),
        ("materials = 1", "scene.toml:1: materials in the scene file must be a table of tables"),
        ("[materials]\nwall = 1", "scene.toml:2: wall in the scene file must be a table of tables"),
        (
            "camera = 1979-05-27",
            "scene.toml:1: camera in the scene file must be a table, [camera], found a date or time",
        ),
        ("image = { width = 16384, height = 16384 }", "scene.toml:1: 16384 × 16384 pixels are too many"),
        ("\u{0}\u{1}", "scene.toml:1: this is not valid TOML"),
    ];
    for (text, expected) in table {
        let error = parse(text).unwrap_err().to_string();
        assert!(error.starts_with(expected), "{text}\n  expected: {expected}\n  found:    {error}");
    }
}

#[test]
fn files_that_are_no_scene_files_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let load = |path: &Path| Scene::load(path, &LoadOptions::default()).unwrap_err().to_string();
    assert!(load(folder.path()).contains("it is a folder; name a file (TOML) in it"));
    assert!(
        load(&folder.path().join("no.toml")).contains("no.toml: cannot read the scene file: there is no such file; ")
    );
    let path = folder.path().join("binary.toml");
    std::fs::write(&path, b"[image]\nwidth = 3 # \xff\xfe\n").unwrap();
    assert!(load(&path).ends_with("binary.toml:2: this is not text in UTF-8; is it a scene file?"));
}

#[test]
fn maps_are_found_beside_the_scene_file_and_single_ones_go_before_the_folder() {
    use relievo_map::{ColorEncoding, HeightMap, NormalMap};
    let folder = tempfile::tempdir().unwrap();
    let maps = folder.path().join("stone");
    std::fs::create_dir(&maps).unwrap();
    let grey =
        |path: &Path, values: [u8; 2]| image::GrayImage::from_raw(2, 1, values.into()).unwrap().save(path).unwrap();
    grey(&maps.join("stone_height.png"), [0, 255]);
    grey(&maps.join("stone_roughness.png"), [255, 0]);
    image::RgbImage::from_raw(1, 1, vec![128, 255, 128]).unwrap().save(maps.join("stone_normal.png")).unwrap();
    image::RgbImage::from_raw(1, 1, vec![255, 0, 0]).unwrap().save(maps.join("stone_color.png")).unwrap();
    grey(&folder.path().join("metal.png"), [255, 255]);
    let text = "[materials.a]\nfrom = \"stone\"\nmetallic = \"metal.png\"\n[materials.b]\nfrom = \"stone\"\nwhite = \"deep\"\n\
                normal_y = \"down\"\nroughness = 0.5\n[[objects]]\nmesh = \"quad\"\nmaterial = \"a\"\n";
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, text).unwrap();
    let scene = Scene::load(&path, &LoadOptions::default()).unwrap();
    let [a, b] = &scene.materials[..] else { panic!() };
    let heights = |map: &Option<HeightMap>| map.as_ref().unwrap().grid().texels().to_vec();
    let normal = |map: &Option<NormalMap>| map.as_ref().unwrap().grid().texels()[0];
    assert_eq!((heights(&a.maps.height), heights(&b.maps.height)), (vec![0.0, 1.0], vec![1.0, 0.0]));
    assert_eq!((normal(&a.maps.normal)[1], normal(&b.maps.normal)[1]), (1.0, -1.0));
    assert_eq!(a.maps.base_color.as_ref().unwrap().encoding, ColorEncoding::Srgb);
    assert_eq!((a.metallic, b.metallic), (1.0, 0.0));
    assert!(a.maps.metallic.is_some() && b.maps.metallic.is_none());
    assert_eq!((a.roughness, b.roughness), (1.0, 0.5));
    assert!(b.maps.roughness.is_some());
    assert!(scene.notes.iter().any(|note| note.ends_with("+Y down, as normal_y says.")), "{:?}", scene.notes);
    let text = "[materials.m]\nnormal = \"stone\"\n[[objects]]\nmesh = \"quad\"\n";
    let error = Scene::parse(text, "s.toml", folder.path(), &LoadOptions::default()).unwrap_err().to_string();
    let expected =
        format!("s.toml:2: normal in [materials.m]: {}: this is a folder, not a regular file", maps.display());
    assert!(error.starts_with(&expected), "{error}");
    // The same again: notes and maps do not depend on which thread was first.
    assert_eq!(Scene::load(&path, &LoadOptions::default()).unwrap().notes, scene.notes);
}

#[test]
fn the_first_broken_map_of_the_file_is_reported_whatever_thread_found_it() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("cut.png"), &crate::glb::png([1, 2, 3])[..40]).unwrap();
    let materials: String =
        (0..20).map(|i| format!("[materials.m{i}]\nao = \"{}\"\n", if i < 7 { "ok.png" } else { "cut.png" })).collect();
    std::fs::write(folder.path().join("ok.png"), crate::glb::png([9, 9, 9])).unwrap();
    let text = format!("{materials}[[objects]]\nmesh = \"quad\"\nmaterial = \"m0\"\n");
    for _ in 0..10 {
        let error = Scene::parse(&text, "s.toml", folder.path(), &LoadOptions::default()).unwrap_err().to_string();
        assert!(error.starts_with("s.toml:16: ao in [materials.m7]: "), "{error}");
    }
}

#[test]
fn the_documented_keys_are_those_that_are_read() {
    let document = Path::new(env!("CARGO_MANIFEST_DIR")).join("SCENE.md");
    let text = std::fs::read_to_string(&document).unwrap();
    let table = relievo_scene::scene_keys_markdown();
    if std::env::var_os("RELIEVO_UPDATE").is_some() {
        let start = text.find("| table |").unwrap();
        std::fs::write(&document, format!("{}{table}", &text[..start])).unwrap();
    } else {
        assert!(
            text.ends_with(&table),
            "SCENE.md is out of date; run this test with RELIEVO_UPDATE=1 to write it anew"
        );
    }
}

#[test]
fn a_grid_counts_vertices_per_side_or_per_texel() {
    let relief = |grid: &str| {
        let text = format!("[materials.a.relief]\ngrid = {grid}\n[[objects]]\nmesh = \"quad\"\n");
        let scene = Scene::parse(&text, "s.toml", Path::new(""), &LoadOptions::default());
        scene.map(|scene| (scene.materials[0].relief.grid, scene.materials[0].relief.vertices_per_texel))
    };
    for (text, expected) in [
        ("50", (50, None)),
        ("\"texel\"", (100, Some(2))),
        ("\"texel:1\"", (100, Some(1))),
        ("\"texel:64\"", (100, Some(64))),
    ] {
        assert_eq!(relief(text).unwrap(), expected, "{text}");
    }
    for text in ["\"texel:0\"", "\"texel:65\"", "\"texel:\"", "\"texels\"", "\"50\""] {
        let error = relief(text).unwrap_err().to_string();
        assert!(error.contains("s.toml:2") && error.contains("\"texel:N\" with N from 1 to 64"), "{error}");
    }
    assert!(relief("1").is_err() && relief("true").is_err());
}
