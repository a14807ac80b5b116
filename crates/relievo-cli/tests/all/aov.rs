//! `--aov`: the numbers in EXR files, the views in PNG files.

use exr::prelude::{FlatSamples, read_first_flat_layer_from_file};

use crate::room::Room;

/// A bare quad seen from the front: every number can be worked out by hand.
const QUAD: &str = r#"
[image]
width = 64
height = 48
[camera]
position = [0, 0, 3]
vertical_fov = 45.0
[[lights]]
kind = "directional"
direction = [0, 0, -1]
[materials.plain]
base_color = [1, 1, 1]
relief = { technique = "none" }
[[objects]]
mesh = "quad"
"#;

/// The channels of an EXR file with their names, each 64 × 48.
fn channels(room: &Room, name: &str) -> Vec<(String, Vec<f32>)> {
    let image = read_first_flat_layer_from_file(room.path(name)).unwrap();
    assert_eq!((image.layer_data.size.x(), image.layer_data.size.y()), (64, 48));
    let channels = image.layer_data.channel_data.list.into_iter();
    channels
        .map(|channel| match channel.sample_data {
            FlatSamples::F32(values) => (channel.name.to_string(), values),
            other => panic!("{name}: {other:?}"),
        })
        .collect()
}

fn channel(room: &Room, file: &str, name: &str) -> Vec<f32> {
    let all = channels(room, file);
    all.iter().find(|(channel, _)| channel == name).unwrap_or_else(|| panic!("{file} has no {name}")).1.clone()
}

fn names(room: &Room, file: &str) -> Vec<String> {
    channels(room, file).into_iter().map(|(name, _)| name).collect()
}

fn at(x: usize, y: usize) -> usize {
    y * 64 + x
}

#[track_caller]
fn near(a: f32, b: f32) {
    assert!((a - b).abs() < 1e-4, "{a} should be {b}");
}

#[test]
fn exr_files_hold_the_numbers_themselves() {
    let room = Room::new();
    room.write("quad.toml", QUAD);
    room.ok("render quad.toml -o out.png --aov depth=depth.exr --aov normal=normal.exr --aov uv=uv.exr \
         --aov fetches=fetches.exr --aov shadow=shadow.exr --aov hit=hit.exr");
    for (file, expected) in
        [("depth", "Y"), ("fetches", "Y"), ("shadow", "Y"), ("hit", "Y"), ("normal", "BGR"), ("uv", "BGR")]
    {
        assert_eq!(names(&room, &format!("{file}.exr")).concat(), expected, "{file}");
    }
    let (corner, centre) = (at(0, 0), at(32, 24));
    // Depth is along the line of sight, not along the ray: 3 all over the quad.
    let depth = channel(&room, "depth.exr", "Y");
    assert_eq!(depth[corner], f32::INFINITY);
    near(depth[centre], 3.0);
    near(depth[at(14, 6)], 3.0);
    let hit = channel(&room, "hit.exr", "Y");
    assert_eq!((hit[corner], hit[centre]), (0.0, 1.0));
    // The quad is 2 units high, the picture 2 · 3 · tan 22.5° = 2.485: 38.6 pixels, and as many wide.
    let covered = hit.iter().filter(|&&hit| hit == 1.0).count();
    assert!((38 * 38..=39 * 39).contains(&covered), "{covered}");
    let normal = ["R", "G", "B"].map(|c| channel(&room, "normal.exr", c)[centre]);
    near(normal[0], 0.0);
    near(normal[1], 0.0);
    near(normal[2], 1.0);
    // Half a pixel to the lower right of the middle; v goes down.
    let off = 0.5 * (2.0 * 3.0 * (22.5f32).to_radians().tan() / 48.0) / 2.0;
    near(channel(&room, "uv.exr", "R")[centre], 0.5 + off);
    near(channel(&room, "uv.exr", "G")[centre], 0.5 + off);
    assert_eq!(channel(&room, "uv.exr", "B"), hit);
    assert!(channel(&room, "fetches.exr", "Y").iter().all(|&n| n == 0.0));
    assert!(channel(&room, "shadow.exr", "Y").iter().all(|&lit| lit == 1.0));
}

#[test]
fn a_relief_shows_in_every_aov() {
    let room = Room::new();
    room.ok(
        "render scene.toml -o out.png --make-size 64 --technique exact --aov depth=depth.exr --aov fetches=fetches.exr \
         --aov shadow=shadow.exr --aov hit=hit.exr --stats s.json",
    );
    room.ok("render scene.toml -o out.png --make-size 64 --technique none --aov depth=flat.exr");
    let hit = channel(&room, "hit.exr", "Y");
    let hits = || (0..hit.len()).filter(|&i| hit[i] > 0.0);
    let (depth, flat) = (channel(&room, "depth.exr", "Y"), channel(&room, "flat.exr", "Y"));
    assert!(hits().all(|i| depth[i] >= flat[i] - 1e-4), "the relief lies below its polygon");
    assert!(hits().filter(|&i| depth[i] > flat[i] + 0.01).count() > 100, "the relief has depth");
    let fetches = channel(&room, "fetches.exr", "Y");
    assert!(hits().all(|i| fetches[i] > 0.0));
    let shadow = channel(&room, "shadow.exr", "Y");
    assert!(shadow.iter().all(|lit| (0.0..=1.0).contains(lit)));
    assert!(hits().any(|i| shadow[i] == 0.0) && hits().any(|i| shadow[i] == 1.0));

    let stats = room.json("s.json");
    assert_eq!(stats["hit_pixels"].as_u64().unwrap(), hits().count() as u64);
    let mean = hits().map(|i| f64::from(fetches[i])).sum::<f64>() / hits().count() as f64;
    assert!((stats["fetches"]["mean"].as_f64().unwrap() - mean).abs() < 1e-6);
    assert_eq!(stats["fetches"]["max"], fetches.iter().copied().fold(0.0, f32::max));
}

#[test]
fn png_files_show_the_same_to_the_eye() {
    let room = Room::new();
    room.ok(
        "render scene.toml -o out.png --make-size 64 --technique exact --aov depth=depth.png --aov normal=normal.png \
         --aov uv=uv.png --aov fetches=fetches.PNG --aov shadow=shadow.png --aov hit=hit.png --aov depth=depth.exr",
    );
    let open = |name: &str| {
        let bytes = std::io::Cursor::new(room.read(name));
        let picture = image::ImageReader::new(bytes).with_guessed_format().unwrap().decode().unwrap();
        assert_eq!((picture.width(), picture.height()), (64, 48), "{name}");
        picture
    };
    let hit = open("hit.png");
    assert_eq!(hit.color(), image::ColorType::L8);
    let hit = hit.into_luma8();

    let depth = open("depth.png");
    assert_eq!(depth.color(), image::ColorType::L16);
    let depth = depth.into_luma16();
    let values = channel(&room, "depth.exr", "Y");
    let finite = values.iter().enumerate().filter(|(_, z)| z.is_finite());
    let nearest = finite.clone().min_by(|a, b| a.1.total_cmp(b.1)).unwrap().0;
    let farthest = finite.max_by(|a, b| a.1.total_cmp(b.1)).unwrap().0;
    assert_eq!((depth.as_raw()[nearest], depth.as_raw()[farthest]), (65535, 0), "near is bright");

    let (normal, uv) = (open("normal.png").into_rgb8(), open("uv.png").into_rgb8());
    for ((hit, normal), uv) in hit.pixels().zip(normal.pixels()).zip(uv.pixels()) {
        let length: f32 = normal.0.map(|x| (f32::from(x) / 127.5 - 1.0).powi(2)).iter().sum();
        if hit[0] == 255 {
            assert!((length.sqrt() - 1.0).abs() < 0.02, "{normal:?}");
        }
        assert_eq!(uv[2], hit[0]);
    }
    let fetches = open("fetches.PNG").into_rgb8();
    assert!(fetches.pixels().any(|p| p[0] > 200), "the costliest pixel is bright");
    let shadow = open("shadow.png").into_luma8();
    assert!(shadow.pixels().any(|p| p[0] == 0) && shadow.pixels().any(|p| p[0] == 255));
}

#[test]
fn a_picture_without_any_surface_has_aovs_too() {
    let room = Room::new();
    room.write("quad.toml", QUAD.replace("[0, 0, 3]", "[0, 0, 3]\ntarget = [0, 0, 9]"));
    room.ok("render quad.toml -o out.png --aov depth=d.exr --aov depth=d.png --aov fetches=f.png --aov hit=h.exr \
         --aov uv=u.png --stats s.json");
    assert!(channel(&room, "d.exr", "Y").iter().all(|&z| z == f32::INFINITY));
    assert!(channel(&room, "h.exr", "Y").iter().all(|&hit| hit == 0.0));
    assert!(room.picture("d.png").pixels().all(|p| p.0 == [0; 3]));
    assert_eq!(room.json("s.json")["hit_pixels"], 0);
}
