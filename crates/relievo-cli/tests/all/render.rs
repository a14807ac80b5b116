//! `relievo render`: pictures, figures, and that they are the same every time.

use std::collections::HashMap;

use relievo_march::Shadow;
use relievo_scene::SurfaceTechnique;
use serde_json::Value;

use crate::files::png;
use crate::room::{KNOWN, Room};

#[test]
fn without_a_scene_the_built_in_wall_is_drawn() {
    let room = Room::new();
    room.ok("render -o out.png --size 64x48 --make-size 64");
    let picture = room.picture("out.png");
    assert_eq!(picture.dimensions(), (64, 48));
    // Bricks are red: a picture of one colour, or of noise, is not a wall.
    let reddish = picture.pixels().filter(|p| p[0] > p[2].saturating_add(20)).count();
    assert!(reddish > 64 * 48 / 3, "{reddish}");
    assert_eq!(room.names(), ["out.png", "scene.toml"]);
}

#[test]
fn every_technique_draws_a_picture_of_its_own() {
    let room = Room::new();
    let mut seen: HashMap<Vec<u8>, &str> = HashMap::new();
    for technique in SurfaceTechnique::names() {
        room.ok(&format!(
            "render scene.toml -o out.png --make-size 64 --technique {technique} --set materials.wall.height_scale=0.08"
        ));
        let twin = seen.insert(room.picture("out.png").into_raw(), technique);
        // Two that miss nothing here may.
        assert!(
            twin.is_none() || (twin, technique) == (Some("cone"), "exact"),
            "{technique} draws what {twin:?} draws"
        );
    }
    assert!(seen.len() >= 12);
}

#[test]
fn every_shadow_draws_a_picture_of_its_own() {
    let room = Room::new();
    let mut seen: HashMap<Vec<u8>, &str> = HashMap::new();
    for shadow in Shadow::ALL.map(Shadow::name) {
        room.ok(&format!("render scene.toml -o out.png --make-size 64 --shadow {shadow}"));
        let twin = seen.insert(room.picture("out.png").into_raw(), shadow);
        assert_eq!(twin, None, "{shadow} draws the same");
    }
    let brightness = |name: &str| -> u64 {
        let (pixels, _) = seen.iter().find(|(_, seen)| **seen == name).unwrap();
        pixels.iter().map(|&x| u64::from(x)).sum()
    };
    assert!(["hard", "soft", "exact"].iter().all(|shadow| brightness(shadow) < brightness("none")));
}

#[test]
fn size_samples_and_overrides_reach_the_picture() {
    let room = Room::new();
    room.ok("render scene.toml -o small.png --make-size 64 --size 20x10");
    assert_eq!(room.picture("small.png").dimensions(), (20, 10));
    room.ok("render scene.toml -o set.png --make-size 64 --set image.width=20 --set image.height=10");
    assert_eq!(room.read("set.png"), room.read("small.png"));

    room.ok("render scene.toml -o one.png --make-size 64");
    room.ok("render scene.toml -o many.png --make-size 64 --samples 9");
    room.ok("render scene.toml -o near.png --make-size 64 --set camera.position.2=0.7");
    assert_ne!(room.read("one.png"), room.read("many.png"));
    assert_ne!(room.read("one.png"), room.read("near.png"));
}

#[test]
fn the_most_samples_are_possible() {
    Room::new().ok("render scene.toml -o out.png --make-size 16 --size 4x3 --samples 4096 --shadow none");
}

#[test]
fn runs_threads_and_repetitions_do_not_change_a_byte() {
    let room = Room::new();
    let aovs = ["depth", "normal", "uv", "fetches", "shadow", "hit"];
    let run = |name: &str, options: &str| {
        let aovs: Vec<String> = aovs.iter().map(|kind| format!("--aov {kind}={name}-{kind}.exr")).collect();
        room.ok(&format!("render scene.toml -o {name}.png --make-size 64 --samples 2 {options} {}", aovs.join(" ")));
    };
    run("a", "--threads 1");
    for (name, options) in [("b", "--threads 1"), ("c", "--threads 2"), ("d", "--threads 7 --frames 3")] {
        run(name, options);
        assert!(room.read("a.png") == room.read(&format!("{name}.png")), "{options}");
        for kind in aovs {
            assert!(
                room.read(&format!("a-{kind}.exr")) == room.read(&format!("{name}-{kind}.exr")),
                "{options} {kind}"
            );
        }
    }
}

#[test]
fn the_stats_are_complete_and_agree_with_each_other() {
    let room = Room::new();
    room.ok("render scene.toml -o out.png --make-size 64 --frames 3 --threads 2 --technique relief --stats s.json");
    let stats = room.json("s.json");
    let mut keys: Vec<&str> = stats.as_object().unwrap().keys().map(String::as_str).collect();
    keys.sort_unstable();
    assert_eq!(
        keys,
        [
            "adapter",
            "backend",
            "build_ms",
            "fetches",
            "frame_ms",
            "frames",
            "height",
            "hit_pixels",
            "iterations",
            "load_ms",
            "peak_bytes",
            "samples",
            "technique",
            "timer",
            "triangles",
            "wall_ms",
            "width"
        ]
    );
    assert_eq!((&stats["backend"], &stats["technique"]), (&Value::from("cpu"), &Value::from("relief")));
    assert_eq!(stats["adapter"], "CPU with 2 threads");
    assert_eq!([&stats["width"], &stats["height"], &stats["frames"], &stats["samples"]], [64, 48, 3, 1]);
    assert_eq!(stats["triangles"], 2);
    let rising = |of: &str, keys: &[&str]| {
        let values: Vec<f64> = keys.iter().map(|key| stats[of][key].as_f64().unwrap()).collect();
        assert!(values.is_sorted() && values[0] > 0.0, "{of}: {values:?}");
    };
    rising("frame_ms", &["min", "median", "max"]);
    assert_eq!((&stats["timer"], &stats["wall_ms"]), (&Value::from("wall"), &stats["frame_ms"]));
    rising("fetches", &["p50", "p95", "p99", "max"]);
    rising("fetches", &["mean", "max"]);
    rising("iterations", &["p50", "p95", "p99", "max"]);
    let hit_pixels = stats["hit_pixels"].as_u64().unwrap();
    assert!((64 * 48 / 3..=64 * 48).contains(&hit_pixels), "{hit_pixels}");
    assert!(stats["build_ms"].as_f64().unwrap() >= 0.0);
    if cfg!(target_os = "linux") {
        assert!((1 << 20..1 << 30).contains(&stats["peak_bytes"].as_u64().unwrap()), "{stats}");
    }

    room.ok("render scene.toml -o out.png --make-size 64 --technique none --stats s.json");
    assert_eq!(room.json("s.json")["fetches"]["max"], 0.0);
}

#[test]
fn stats_to_stdout_are_json_and_nothing_else() {
    let room = Room::new();
    let outcome = room.ok("render scene.toml -o out.png --make-size 16 --stats -");
    let stats: Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert_eq!(stats["width"], 64);
    assert_eq!(room.names(), ["out.png", "scene.toml"]);
}

#[test]
fn names_with_spaces_and_other_letters_work_everywhere() {
    let room = Room::new();
    room.write("mein Stein/höhe 石.png", png(32, 32));
    room.write(
        "mein Stein/szene ü.toml",
        "[materials.\"a b\"]\nheight = \"höhe 石.png\"\n[[objects]]\nmesh = \"quad\"\nmaterial = \"a b\"\n\
         [[lights]]\nkind = \"point\"\nposition = [0, 0, 2]\n[image]\nwidth = 16\nheight = 12\n",
    );
    let outcome = room.run([
        "render",
        "mein Stein/szene ü.toml",
        "-o",
        "mein Stein/bild 1.png",
        "--aov",
        "hit=mein Stein/treffer é.png",
        "--stats",
        "mein Stein/zahlen = gut.json",
    ]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert_eq!(room.picture("mein Stein/bild 1.png").dimensions(), (16, 12));
    assert_eq!(room.picture("mein Stein/treffer é.png").dimensions(), (16, 12));
    assert!(room.json("mein Stein/zahlen = gut.json")["fetches"]["mean"].as_f64().unwrap() > 0.0);
}

#[test]
fn a_finished_picture_takes_the_place_of_the_old_one_alone() {
    let room = Room::new();
    assert_eq!(room.read("out.png"), KNOWN);
    room.ok("render scene.toml -o out.png --make-size 16 --size 4x3");
    assert_eq!(room.picture("out.png").dimensions(), (4, 3));
    assert_eq!(room.names(), ["out.png", "scene.toml"]);
}

#[cfg(unix)]
#[test]
fn two_outputs_may_both_go_to_nowhere() {
    let room = Room::new();
    std::os::unix::fs::symlink("/dev/null", room.path("null.exr")).unwrap();
    room.ok("render scene.toml -o out.png --make-size 16 --aov uv=null.exr --aov hit=null.exr --stats /dev/null");
}

#[test]
fn a_relief_that_is_seen_from_behind_is_said_to_be_none_or_drawn() {
    let room = Room::new();
    let behind = "render scene.toml -o out.png --make-size 64 --set camera.position=[-0.9,-0.5,-1.3]";
    let noted = |arguments: &str| room.ok(arguments).stderr.matches("is seen from behind").count();
    assert_eq!(noted(behind), 1);
    let empty = room.picture("out.png");
    assert!(empty.pixels().all(|pixel| pixel == empty.get_pixel(0, 0)));
    assert_eq!(noted(&format!("{behind} --set materials.wall.two_sided=true")), 0);
    let drawn = room.picture("out.png");
    assert!(drawn.pixels().any(|pixel| pixel != drawn.get_pixel(0, 0)));
    assert_eq!(noted(&format!("{behind} --technique normal")), 0);
    assert_eq!(noted("render scene.toml -o out.png --make-size 64"), 0);
}
