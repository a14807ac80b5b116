//! Reliefs that were once drawn wrongly, one scene of each kind, drawn by the command on the CPU and, where there is one, on a
//! GPU, and judged by displaced geometry or by what must be the same picture.

use std::fmt::Write;

use exr::prelude::{FlatSamples, read_first_flat_layer_from_file};
use image::{GrayImage, Luma, Rgb, RgbImage};
use serde_json::Value;

use crate::room::{Outcome, Room};

const HEAD: &str = r#"
[image]
width = 120
height = 90
[[lights]]
kind = "directional"
direction = [-0.3, -0.4, -1.0]
"#;

/// The end of a scene: one object that wears material `m`.
fn object(mesh: &str) -> String {
    format!("[[objects]]\nmesh = \"{mesh}\"\nmaterial = \"m\"\n")
}

/// A scene with a camera, the keys of material `m` and of its relief, and an object.
fn scene(eye: &str, material: &str, relief: &str, mesh: &str) -> String {
    let camera = format!("[camera]\nposition = {eye}\nvertical_fov = 50\n");
    format!("{HEAD}{camera}[materials.m]\n{material}\n[materials.m.relief]\n{relief}\n{}", object(mesh))
}

const EYE: &str = "[-0.9, -1.4, 0.8]";

/// What a picture shows, pixel by pixel.
struct Shown {
    hit: Vec<bool>,
    uv: Vec<[f32; 2]>,
    depth: Vec<f32>,
    normal: Vec<[f32; 3]>,
    shadow: Vec<f32>,
    said: String,
}

impl Shown {
    fn count(&self) -> usize {
        self.hit.iter().filter(|&&hit| hit).count()
    }

    /// Pixels in which one of two pictures alone shows relief.
    fn masks_apart(&self, other: &Self) -> usize {
        self.hit.iter().zip(&other.hit).filter(|(a, b)| a != b).count()
    }

    /// The same as it shows through another picture's polygons: displaced geometry is seen beside them too.
    fn through(mut self, polygons: &Self) -> Self {
        self.hit.iter_mut().zip(&polygons.hit).for_each(|(hit, polygon)| *hit &= polygon);
        self
    }

    /// Of the pixels in which both show relief, the share whose uvs are farther apart than this; whole repeats do not count.
    fn share_apart(&self, other: &Self, limit: f32) -> f64 {
        let both = (0..self.hit.len()).filter(|&i| self.hit[i] && other.hit[i]);
        let apart = |i: usize| {
            let [u, v] = [0, 1].map(|k| self.uv[i][k] - other.uv[i][k]).map(|d| d - d.round());
            u.hypot(v)
        };
        let count = both.clone().count();
        assert!(count > 200, "{count} pixels");
        both.filter(|&i| !(apart(i) <= limit)).count() as f64 / count as f64
    }
}

fn channels(room: &Room, name: &str) -> Vec<(String, Vec<f32>)> {
    let image = read_first_flat_layer_from_file(room.path(name)).unwrap();
    let channels = image.layer_data.channel_data.list.into_iter();
    channels
        .map(|channel| match channel.sample_data {
            FlatSamples::F32(values) => (channel.name.to_string(), values),
            other => panic!("{name}: {other:?}"),
        })
        .collect()
}

fn run(room: &Room, backend: &str, arguments: &str) -> Outcome {
    let outcome = match backend {
        #[cfg(feature = "gpu")]
        "gpu" => room.run_with_gpus(arguments),
        _ => room.run(arguments.split_whitespace()),
    };
    assert_eq!(outcome.code, Some(0), "{arguments}: {}", outcome.stderr);
    outcome
}

/// Draws `scene.toml` of a room with these changes.
fn shown(room: &Room, backend: &str, changes: &str) -> Shown {
    let mut arguments = format!("render scene.toml -o out.png --make-size 128 --backend {backend}");
    for kind in ["hit", "uv", "depth", "normal", "shadow"] {
        write!(arguments, " --aov {kind}={kind}.exr").unwrap();
    }
    for change in changes.split_whitespace() {
        write!(arguments, " --set {change}").unwrap();
    }
    let said = run(room, backend, &arguments).stderr;
    let one = |kind: &str| channels(room, &format!("{kind}.exr")).swap_remove(0).1;
    let three = |kind: &str| {
        let all = channels(room, &format!("{kind}.exr"));
        let of = |name: &str| &all.iter().find(|channel| channel.0 == name).unwrap().1;
        let [r, g, b] = ["R", "G", "B"].map(of);
        (0..r.len()).map(|i| [r[i], g[i], b[i]]).collect::<Vec<_>>()
    };
    Shown {
        hit: one("hit").into_iter().map(|hit| hit > 0.5).collect(),
        uv: three("uv").into_iter().map(|[u, v, _]| [u, v]).collect(),
        depth: one("depth"),
        normal: three("normal"),
        shadow: one("shadow"),
        said,
    }
}

const DISPLACED: &str = "materials.m.relief.technique=displacement materials.m.relief.grid=400";
const FLAT: &str = "materials.m.relief.technique=none";

/// The backends that there are: the CPU, and a GPU.
fn backends() -> Vec<&'static str> {
    #[cfg(feature = "gpu")]
    if !crate::gpu::devices().is_empty() {
        return vec!["cpu", "gpu"];
    }
    vec!["cpu"]
}

fn room(scene: &str) -> Room {
    let room = Room::new();
    room.write("scene.toml", scene);
    room
}

/// Writes a grey picture of this many texels along a side.
fn heights(room: &Room, name: &str, side: u32, height: impl Fn(f32, f32) -> f32) {
    let at = |x: u32| (x as f32 + 0.5) / side as f32;
    GrayImage::from_fn(side, side, |x, y| Luma([(height(at(x), at(y)).clamp(0.0, 1.0) * 255.0).round() as u8]))
        .save(room.path(name))
        .unwrap();
}

/// Smooth bumps that tile.
fn bumps(u: f32, v: f32) -> f32 {
    let wave = |x: f32| (x * std::f32::consts::TAU).sin();
    0.5 + 0.3 * wave(2.0 * u) * wave(3.0 * v + 0.1) + 0.2 * wave(v + u)
}

/// A square of the quad's size whose uvs span this range, as an OBJ file.
fn square(low: f32, high: f32) -> String {
    format!(
        "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt {low} {low}\nvt {high} {low}\nvt {high} {high}\nvt {low} {high}\nvn 0 0 1\n\
         f 1/1/1 2/2/1 3/3/1 4/4/1\n"
    )
}

/// The figures of one technique in a comparison.
fn compared(room: &Room, changes: &str, technique: &str) -> Value {
    let sets: String = changes.split_whitespace().map(|change| format!(" --set {change}")).collect();
    let run = format!("compare scene.toml --make-size 64 --samples 1 --techniques {technique} --json -{sets}");
    let outcome = room.ok(&run);
    serde_json::from_str(&outcome.stdout).unwrap()
}

fn figure(json: &Value, key: &str) -> f64 {
    json["techniques"][0]["hit_error"][key].as_f64().unwrap()
}

#[test]
fn a_clipped_relief_ends_with_its_polygon_whatever_the_uvs_of_the_file() {
    let room = room(&scene(EYE, "height = \"h.png\"\ndepth = 0.16", "edge = \"clip\"", "part.obj"));
    heights(&room, "h.png", 64, bumps);
    for (low, high) in [(0.0, 3.0), (-1.0, 0.0), (0.25, 0.75)] {
        room.write("part.obj", square(low, high));
        for backend in backends() {
            let clipped = shown(&room, backend, "");
            let truth = shown(&room, "cpu", DISPLACED).through(&shown(&room, "cpu", FLAT));
            let (apart, all) = (clipped.masks_apart(&truth), truth.count());
            assert!(apart * 100 < all, "{backend}, {low} to {high}: {apart} of {all} pixels");
            assert!(clipped.share_apart(&truth, 1.0 / 64.0) < 0.01, "{backend}, {low} to {high}");
            let wrapped = shown(&room, backend, "materials.m.relief.edge=wrap");
            assert!(wrapped.masks_apart(&truth) * 50 > all, "{backend}: nothing is cut");
        }
    }
}

/// Hills over a plane in n × n squares, as an OBJ file.
fn hills(n: u32) -> String {
    let mut obj = String::new();
    let height = |x: f32, y: f32| 0.3 * (2.1 * x).sin() * (1.7 * y).cos();
    for j in 0..=n {
        for i in 0..=n {
            let [u, v] = [i, j].map(|k| k as f32 / n as f32);
            let (x, y) = (2.0 * u - 1.0, 2.0 * v - 1.0);
            let (dx, dy) =
                (0.3 * 2.1 * (2.1 * x).cos() * (1.7 * y).cos(), -0.3 * 1.7 * (2.1 * x).sin() * (1.7 * y).sin());
            writeln!(obj, "v {x} {y} {}\nvt {u} {v}\nvn {} {} 1", height(x, y), -dx, -dy).unwrap();
        }
    }
    for j in 0..n {
        for i in 0..n {
            let a = j * (n + 1) + i + 1;
            let corner = |k: u32| format!("{k}/{k}/{k}");
            let [a, b, c, d] = [a, a + 1, a + n + 2, a + n + 1].map(corner);
            writeln!(obj, "f {a} {b} {c} {d}").unwrap();
        }
    }
    obj
}

#[test]
fn smooth_normals_and_changing_densities_are_judged_by_displaced_geometry() {
    // Twice the texture on the right half.
    let wall = "v -1 -1 0\nv 0 -1 0\nv 1 -1 0\nv -1 1 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt .5 0\nvt 1.5 0\nvt 0 1\nvt .5 1\nvt 1.5 1\n\
                vn 0 0 1\nf 1/1/1 2/2/1 5/5/1 4/4/1\nf 2/2/1 3/3/1 6/6/1 5/5/1\n";
    let room = room(&scene(EYE, "height = \"h.png\"\ndepth = 0.12", "edge = \"silhouette\"", "m.obj"));
    heights(&room, "h.png", 64, bumps);
    for (name, mesh) in [("wall", wall.to_owned()), ("hills", hills(6))] {
        room.write("m.obj", mesh);
        let exact = compared(&room, "", "exact");
        assert!(figure(&exact, "wrong") <= 0.003 && figure(&exact, "outline_iou") >= 0.995, "{name}: {exact:#}");
        assert!(exact["techniques"][0]["flip"].as_f64().unwrap() <= 0.02, "{name}: {exact:#}");
        // By the frame alone, and by averages over neighbours.
        let frame = compared(&room, "materials.m.relief.edge=wrap", "exact");
        assert!(name != "wall" || figure(&frame, "off") <= 0.03, "{frame:#}");
        let steep = compared(&room, "", "steep");
        assert!(figure(&steep, "wrong") > 0.02 && figure(&steep, "outline_iou") < 0.995, "{name}: {steep:#}");
        let cpu = shown(&room, "cpu", "");
        for backend in backends() {
            let drawn = shown(&room, backend, "");
            let (apart, all) = (drawn.masks_apart(&cpu), cpu.count());
            assert!(
                apart * 200 <= all && drawn.share_apart(&cpu, 0.1 / 64.0) < 0.005,
                "{name}, {backend}: {apart} of {all}"
            );
        }
    }
}

#[test]
fn level_of_detail_does_not_flicker() {
    let wall = "from = \"make:brick-wall\"\nheight_scale = 0.05";
    let room = room(&(scene("[0.0, -3.464, 2.0]", wall, "lod = true", "quad") + "scale = 4.0\nuv_repeat = 4\n"));
    for backend in backends() {
        let picture = |x: f32| {
            let moved = format!("--set camera.position=[{x},-3.464,2.0] --set camera.target=[{x},0,0]");
            run(&room, backend, &format!("render scene.toml -o p.png --make-size 128 --backend {backend} {moved}"));
            room.picture("p.png")
        };
        let over = |a: &RgbImage, b: &RgbImage| {
            a.pixels().zip(b.pixels()).filter(|(a, b)| (0..3).any(|k| a[k].abs_diff(b[k]) > 12)).count()
        };
        let (still, moved, far) = (picture(0.0), picture(1e-6), picture(0.1));
        assert_eq!(over(&still, &moved), 0, "{backend}");
        assert!(over(&still, &far) > 100, "{backend}: the judge sees nothing");
    }
}

#[test]
fn many_repeats_and_many_triangles_are_compared_and_a_coarse_truth_says_so() {
    let room = room(&scene("[0.0, -2.6, 0.9]", "from = \"make:brick-wall\"", "edge = \"wrap\"", "quad"));
    let flip = |json: &Value| json["techniques"][0]["flip"].as_f64().unwrap();
    let mut flips = Vec::new();
    for k in [1, 20, 100] {
        let json = compared(&room, &format!("objects.0.scale={k} objects.0.uv_repeat={k}"), "exact");
        assert!(figure(&json, "off") < 0.003 && json["truth"]["notes"].as_array().unwrap().is_empty(), "{json:#}");
        flips.push(flip(&json));
    }
    let none = flip(&compared(&room, "", "none"));
    assert!(flips.iter().all(|&f| f <= 1.2 * flips[0]) && 2.0 * flips[0] < none, "{flips:?}, {none}");
    room.write("m.obj", hills(8));
    let many = compared(&room, "objects.0.mesh=m.obj materials.m.relief.edge=silhouette", "exact");
    assert!(flip(&many) < 0.02 && figure(&many, "wrong") <= 0.003, "{many:#}");
    let sets = "--set objects.0.scale=20 --set objects.0.uv_repeat=20 --truth-grid 50";
    let coarse = room.ok(&format!("compare scene.toml --make-size 64 --samples 1 --techniques exact --json - {sets}"));
    let coarse: Value = serde_json::from_str(&coarse.stdout).unwrap();
    assert!(!coarse["truth"]["notes"].as_array().unwrap().is_empty(), "{coarse:#}");
}

#[test]
fn an_eye_and_a_lamp_inside_a_valley() {
    let valley = |u: f32, _: f32| (((u - 0.5).abs() - 0.2) * 8.0).clamp(0.0, 1.0);
    let text = scene("[0.02, -0.9, 0.1]", "height = \"h.png\"\ndepth = 0.4\nmidlevel = 0.0", "edge = \"wrap\"", "quad");
    let room = room(&text.replace("vertical_fov = 50", "vertical_fov = 60\ntarget = [0.1, 0.3, -0.1]\nup = [0, 0, 1]"));
    heights(&room, "h.png", 64, valley);
    for backend in backends() {
        let (relief, polygon) = (shown(&room, backend, ""), shown(&room, backend, FLAT));
        assert_eq!(relief.masks_apart(&polygon), 0, "{backend}: holes");
        let truth = shown(&room, "cpu", DISPLACED);
        let far =
            (0..truth.depth.len()).filter(|&i| relief.hit[i] && !((relief.depth[i] - truth.depth[i]).abs() < 0.03));
        assert!(far.count() * 200 < relief.count(), "{backend}");
    }
    let below =
        scene("[-0.5, -1.9, 1.3]", "height = \"h.png\"\ndepth = 0.4", "edge = \"clip\"\nshadow = \"exact\"", "quad");
    room.write(
        "scene.toml",
        below.replace(
            "kind = \"directional\"\ndirection = [-0.3, -0.4, -1.0]",
            "kind = \"point\"\nposition = [0.02, -0.3, -0.15]",
        ),
    );
    for backend in backends() {
        for z in ["-0.05", "-0.15", "-0.3"] {
            let lamp = format!("lights.0.position=[0.02,-0.3,{z}]");
            let (relief, truth) = (shown(&room, backend, &lamp), shown(&room, "cpu", &format!("{lamp} {DISPLACED}")));
            let dark = |a: &Shown, b: &Shown| {
                (0..a.hit.len()).filter(|&i| a.hit[i] && b.hit[i] && b.shadow[i] - a.shadow[i] > 0.5).count()
            };
            let all = truth.count();
            let (darker, lighter) = (dark(&relief, &truth), dark(&truth, &relief));
            assert!((darker + lighter) * 250 <= all, "{backend}, {z}: {darker} darker, {lighter} lighter of {all}");
            let high = shown(&room, backend, "lights.0.position=[0.02,-0.3,0.4]");
            assert!(dark(&relief, &high) + dark(&high, &relief) > all / 50, "{backend}, {z}: the lamp does not count");
        }
    }
}

#[test]
fn uvs_far_from_zero_show_what_near_ones_show() {
    let wall = "from = \"make:brick-wall\"\nheight_scale = 0.03";
    let room = room(&scene("[-0.3, -0.9, 0.25]", wall, "edge = \"wrap\"\nshadow = \"exact\"", "m.obj"));
    for backend in backends() {
        let at = |low: f32| {
            room.write("m.obj", square(low, low + 1.0));
            shown(&room, backend, "")
        };
        let near = at(0.0);
        for low in [1000.0, -10_000.0] {
            let far = at(low);
            assert_eq!(far.masks_apart(&near), 0, "{backend}, {low}");
            assert_eq!(far.share_apart(&near, 0.05 / 128.0), 0.0, "{backend}, {low}");
        }
        assert!(at(0.5).share_apart(&near, 0.05 / 128.0) > 0.9, "{backend}: the judge sees nothing");
    }
}

#[test]
fn faces_show_their_own_part_of_an_atlas() {
    // Two squares side by side, each with half of the atlas.
    let two = "v -2 -1 0\nv 0 -1 0\nv 0 1 0\nv -2 1 0\nv 2 -1 0\nv 2 1 0\nvt 0 0\nvt .5 0\nvt .5 1\nvt 0 1\nvt 1 0\nvt 1 1\n\
               vn 0 0 1\nvn 0 0.0001 1\nf 1/1/1 2/2/1 3/3/1 4/4/1\nf 2/2/2 5/5/2 6/6/2 3/3/2\n";
    let text = scene("[-4.6, 0.3, 1.6]", "height = \"h.png\"\ndepth = 0.3", "edge = \"clip\"", "m.obj");
    let room = room(&text.replace("vertical_fov = 50", "vertical_fov = 40\nup = [0, 0, 1]"));
    room.write("m.obj", two);
    heights(&room, "h.png", 64, |u, v| if u < 0.5 { bumps(2.0 * u, v) } else { 0.2 + 0.8 * bumps(4.0 * u, 2.0 * v) });
    let polygons = shown(&room, "cpu", FLAT);
    for backend in backends() {
        let (relief, mut truth) = (shown(&room, backend, ""), shown(&room, "cpu", DISPLACED).through(&polygons));
        // What one square shows through the other's polygon is not the other's.
        let half = |shown: &Shown, i: usize| shown.uv[i][0] < 0.5;
        (0..truth.hit.len()).for_each(|i| truth.hit[i] &= half(&truth, i) == half(&polygons, i));
        let (apart, all) = (relief.masks_apart(&truth), truth.count());
        assert!(apart * 100 < all && relief.share_apart(&truth, 1.0 / 64.0) < 0.01, "{backend}: {apart} of {all}");
        // A part that the material names.
        let part = shown(&room, backend, "materials.m.uv_rect=[0.5,0,1,1]");
        let right = (0..part.hit.len()).filter(|&i| part.hit[i]).all(|i| part.uv[i][0] >= 0.5);
        assert!(right && part.count() > 200 && part.count() < all, "{backend}: {}", part.count());
        let same = shown(&room, "cpu", &format!("materials.m.uv_rect=[0.5,0,1,1] {DISPLACED}")).through(&polygons);
        assert!(part.masks_apart(&same) * 50 < part.count(), "{backend}: displaced geometry ends there too");
    }
}

#[test]
fn nearest_heights_are_columns() {
    let room = room(&scene(EYE, "height = \"h.png\"\ndepth = 0.3", "edge = \"wrap\"", "quad"));
    let blocks = |u: f32, v: f32| (((u * 8.0) as u32 * 5 + (v * 8.0) as u32 * 3) % 4) as f32 / 3.0;
    heights(&room, "h.png", 8, blocks);
    heights(&room, "large.png", 512, blocks);
    for backend in backends() {
        let nearest = shown(&room, backend, "materials.m.filter=nearest");
        let large = shown(&room, backend, "materials.m.height=large.png");
        assert_eq!(nearest.masks_apart(&large), 0, "{backend}");
        assert!(nearest.share_apart(&large, 0.1 / 8.0) < 0.01, "{backend}");
        assert!(shown(&room, backend, "").share_apart(&large, 0.1 / 8.0) > 0.2, "{backend}: ramps are told apart");
        // Tops are level, walls upright.
        let normals = (0..nearest.hit.len()).filter(|&i| nearest.hit[i]).map(|i| nearest.normal[i]);
        let (tops, walls): (Vec<_>, Vec<_>) = normals.partition(|n| n[2] > 0.5);
        assert!(tops.len() > 500 && walls.len() > 200, "{backend}: {} tops, {} walls", tops.len(), walls.len());
        assert!(tops.iter().all(|n| n[2] > 0.999) && walls.iter().all(|n| n[2].abs() < 0.02), "{backend}");
    }
    let right = compared(&room, "materials.m.filter=nearest", "exact");
    assert!(figure(&right, "off") < 0.003, "{right:#}");
    let ramps = compared(&room, "materials.m.filter=nearest", "steep");
    assert!(figure(&ramps, "off") > figure(&right, "off"), "{ramps:#}");
}

#[test]
fn sheets_have_two_sides_where_the_material_says_so() {
    let material = "height = \"h.png\"\ndepth = 0.2\nmidlevel = 0.5";
    let room = room(&scene("[0.6, -1.4, -1.3]", material, "edge = \"wrap\"", "quad"));
    heights(&room, "h.png", 64, bumps);
    for backend in backends() {
        let polygon = shown(&room, backend, "materials.m.relief.technique=normal");
        let both = shown(&room, backend, "materials.m.two_sided=true");
        assert_eq!(both.masks_apart(&polygon), 0, "{backend}");
        assert!(both.share_apart(&polygon, 1.0 / 64.0) > 0.2, "{backend}: flat");
        let one = shown(&room, backend, "");
        assert!(one.count() == 0 && one.said.contains("two_sided = true"), "{backend}: {}", one.said);
    }
}

#[test]
fn textures_are_moved_and_turned() {
    let room = room(&scene("[0, 0, 2.5]", "base_color = \"c.png\"", "technique = \"normal\"", "quad"));
    RgbImage::from_fn(16, 16, |x, y| Rgb([x as u8 * 17, y as u8 * 17, 0])).save(room.path("c.png")).unwrap();
    for backend in backends() {
        let plain = shown(&room, backend, "");
        let moved = shown(&room, backend, "materials.m.uv_offset=[0.25,0.5] materials.m.uv_rotate=90");
        for i in (0..plain.hit.len()).filter(|&i| plain.hit[i]) {
            // u to the right and v down, turned by a quarter as KHR_texture_transform turns: (u, v) to (v, −u).
            let [u, v] = plain.uv[i];
            let expected = [0.25 + v, 0.5 - u];
            let off = [0, 1].map(|k| (moved.uv[i][k] - expected[k]).abs());
            assert!(off[0].max(off[1]) < 1e-4, "{backend}: {:?} for {expected:?}", moved.uv[i]);
        }
    }
}

#[test]
fn a_seam_between_mirrored_halves_of_a_flat_normal_map_is_not_seen() {
    let room = room(&scene("[0, 0, 3]", "normal = \"n.png\"", "technique = \"normal\"", "m.obj"));
    RgbImage::from_pixel(4, 4, Rgb([128, 128, 255])).save(room.path("n.png")).unwrap();
    room.write(
        "m.obj",
        "v -1 -1 0\nv 0 -1 0\nv 0 1 0\nv -1 1 0\nv 1 -1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n\
         f 1/1/1 2/2/1 3/3/1 4/4/1\nf 2/2/1 5/1/1 6/4/1 3/3/1\n",
    );
    for backend in backends() {
        let flat = shown(&room, backend, "");
        let tilt = |shown: &Shown| {
            let normals = (0..shown.hit.len()).filter(|&i| shown.hit[i]).map(|i| shown.normal[i]);
            normals.map(|n| n[0].hypot(n[1])).fold(0.0, f32::max)
        };
        assert!(flat.count() > 1000 && tilt(&flat) < 1e-5, "{backend}: {}", tilt(&flat));
        RgbImage::from_pixel(4, 4, Rgb([131, 128, 255])).save(room.path("tilted.png")).unwrap();
        assert!(tilt(&shown(&room, backend, "materials.m.normal=tilted.png")) > 0.01, "{backend}");
    }
}

#[test]
fn orthographic_cameras_see_what_narrow_ones_see_from_afar() {
    let towards = "[-487.377325, -758.142506, 433.224289]";
    let text = scene(towards, "height = \"h.png\"\ndepth = 0.16", "edge = \"wrap\"", "quad");
    let room = room(&text.replace("vertical_fov = 50", "vertical_fov = 0.16042808"));
    heights(&room, "h.png", 64, bumps);
    for backend in backends() {
        let narrow = shown(&room, backend, "");
        let parallel = shown(&room, backend, "camera.kind=orthographic camera.size=2.8");
        let all = narrow.count();
        assert!(
            all > 1000 && narrow.masks_apart(&parallel) * 200 <= all,
            "{backend}: {}",
            narrow.masks_apart(&parallel)
        );
        assert!(narrow.share_apart(&parallel, 0.3 / 64.0) < 0.01, "{backend}");
        let larger = shown(&room, backend, "camera.kind=orthographic camera.size=3.0");
        assert!(narrow.share_apart(&larger, 0.3 / 64.0) > 0.5, "{backend}: the judge sees nothing");
    }
}
