//! `--backend gpu`, `--adapter` and `devices`, on whatever adapter the machine has.

use relievo_lab::pixel_difference;
use relievo_map::Grid;
use serde_json::Value;

use crate::room::{KNOWN, Room};

/// The environment variable with which CI says that there is an adapter: without one, tests fail then.
const REQUIRE: &str = "RELIEVO_REQUIRE_ADAPTER";

/// The machine's adapters, with a word about what is skipped where there are none.
pub(crate) fn devices() -> Vec<Value> {
    let listed = Room::new().run_with_gpus("devices --json -");
    assert_eq!(listed.code, Some(0), "{}", listed.stderr);
    let devices: Vec<Value> = serde_json::from_str(&listed.stdout).unwrap();
    if devices.is_empty() {
        assert!(std::env::var_os(REQUIRE).is_none(), "{REQUIRE} is set, but there is no adapter: {}", listed.stderr);
        eprintln!("skipped: no adapter");
    }
    devices
}

/// A room on a machine with adapters and their list; or a word about the test that is skipped.
fn room() -> Option<(Room, Vec<Value>)> {
    let devices = devices();
    (!devices.is_empty()).then(|| (Room::new(), devices))
}

#[track_caller]
fn ok(room: &Room, arguments: &str) -> String {
    let outcome = room.run_with_gpus(arguments);
    assert_eq!(outcome.code, Some(0), "{arguments}: {}", outcome.stderr);
    outcome.stderr
}

fn grid(room: &Room, name: &str) -> Grid<[u8; 3]> {
    let picture = room.picture(name);
    let (width, height) = picture.dimensions();
    Grid::new(width, height, picture.pixels().map(|pixel| pixel.0).collect()).unwrap()
}

#[test]
fn without_a_desktop_all_that_is_said_is_ours() {
    let Some((room, _)) = room() else { return };
    let lab =
        "lab spikes -o lab --size 16 --rays 32 --angles 60 --depths 5 --minify 1 --techniques exact --no-pictures";
    for arguments in [
        "devices",
        "render scene.toml -o gpu.png --make-size 16 --backend gpu",
        "render scene.toml -o auto.png --make-size 16",
        &format!("{lab} --backend gpu"),
        "tune spikes --max-error 1 --depth 25 --size 32 --rays 64 --cost fetches --backend gpu",
    ] {
        room.run_with_gpus(arguments).assert_only_notes();
    }
    // The name by which it was called stays, and so do its arguments.
    assert!(room.run_with_gpus("--help").stdout.contains("Usage: relievo "));
    assert_eq!(room.run_with_gpus("devices --json").code, Some(2));
}

#[test]
fn the_built_in_wall_is_the_same_on_cpu_and_gpu() {
    let Some((room, _)) = room() else { return };
    for options in ["", "--technique occlusion --shadow soft", "--samples 2 --technique relief --shadow hard"] {
        let wall = format!("--size 201x151 --make-size 128 {options}");
        ok(&room, &format!("render -o cpu.png --backend cpu {wall}"));
        let said = ok(&room, &format!("render -o gpu.png --backend gpu {wall}"));
        assert!(said.contains("note: drawing on ") && said.contains(", as asked"), "{said}");
        // The project's own measure for all backends.
        let difference = pixel_difference(&grid(&room, "cpu.png"), &grid(&room, "gpu.png"), 8).unwrap();
        assert!(difference.mean <= 1.0 && difference.over <= 0.005, "{options}: {difference:?}");
    }
}

#[test]
fn stats_and_aovs_come_from_the_gpu_too() {
    let Some((room, devices)) = room() else { return };
    let aovs = ["depth", "normal", "uv", "fetches", "shadow", "hit"].map(|kind| format!("--aov {kind}={kind}.exr"));
    let run = format!("render scene.toml --make-size 64 --frames 3 {} -o", aovs.join(" "));
    ok(&room, &format!("{run} cpu.png --backend cpu --stats cpu.json"));
    ok(&room, &format!("{run} gpu.png --backend gpu --stats gpu.json"));
    let (cpu, gpu) = (room.json("cpu.json"), room.json("gpu.json"));
    let keys = |stats: &Value| stats.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    assert_eq!(keys(&cpu), keys(&gpu));
    assert_eq!(gpu["backend"], "gpu");
    assert!(devices.iter().any(|device| device["adapter"] == gpu["adapter"]), "{gpu}");
    assert_eq!([&gpu["frames"], &gpu["width"], &gpu["triangles"]], [3, 64, 2]);
    let timed = devices.iter().any(|device| device["adapter"] == gpu["adapter"] && device["timestamps"] == true);
    assert_eq!(gpu["timer"], if timed { "gpu" } else { "wall" });
    for times in ["frame_ms", "wall_ms"] {
        let of = |key| gpu[times][key].as_f64().unwrap();
        assert!(0.0 < of("min") && of("min") <= of("median") && of("median") <= of("max"), "{gpu}");
    }
    let near = |a: &Value, b: &Value, share: f64| {
        let (a, b) = (a.as_f64().unwrap(), b.as_f64().unwrap());
        assert!((a - b).abs() <= share * a, "{a} on the CPU, {b} on the GPU");
    };
    near(&cpu["hit_pixels"], &gpu["hit_pixels"], 0.005);
    near(&cpu["fetches"]["mean"], &gpu["fetches"]["mean"], 0.01);
}

#[test]
fn an_adapter_is_found_by_a_part_of_its_name() {
    let Some((room, devices)) = room() else { return };
    let interface = devices[0]["interface"].as_str().unwrap().to_lowercase();
    let said = ok(&room, &format!("render scene.toml -o new.png --make-size 16 --adapter {interface}"));
    assert!(said.contains(devices[0]["adapter"].as_str().unwrap()), "{said}");

    let outcome = room.run_with_gpus("render scene.toml -o out.png --backend gpu --adapter nobodys");
    assert_eq!(outcome.code, Some(1));
    assert!(outcome.stderr.contains("\"nobodys\""), "{}", outcome.stderr);
    assert!(devices.iter().all(|device| outcome.stderr.contains(device["adapter"].as_str().unwrap())));
    assert_eq!(room.read("out.png"), KNOWN);
}

#[test]
fn devices_tell_what_they_can_do() {
    let Some((room, devices)) = room() else { return };
    let text = room.run_with_gpus("devices").stdout;
    for device in &devices {
        assert!(text.contains(device["adapter"].as_str().unwrap()), "{text}");
        assert!(device["max_texture_side"].as_u64().unwrap() >= 2048, "{device}");
        assert!(["full", "webgpu", "webgl2"].contains(&device["tier"].as_str().unwrap()), "{device}");
    }
    assert_eq!(text.matches("  textures   up to ").count(), devices.len());
}

#[test]
fn no_adapter_is_an_empty_list_with_a_word() {
    let room = Room::new();
    let listed = room.ok("devices --json -");
    assert_eq!(listed.stdout, "[]\n");
    assert!(listed.stderr.contains("note: no GPU adapter was found: install "), "{}", listed.stderr);
    assert_eq!(room.ok("devices").stdout, "");
}

#[test]
fn broken_scenes_fail_on_the_gpu_as_on_the_cpu() {
    let Some((room, _)) = room() else { return };
    room.write("empty.toml", "");
    for (scene, says) in [("empty.toml", "[[objects]]"), ("no.toml", "there is no such file")] {
        let outcome = room.run_with_gpus(&format!("render {scene} -o out.png --backend gpu"));
        assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
        assert!(outcome.stderr.contains(says) && !outcome.stderr.contains("panicked"), "{}", outcome.stderr);
        assert_eq!(room.read("out.png"), KNOWN);
    }
}

#[test]
fn ten_thousand_objects_are_drawn() {
    let Some((room, _)) = room() else { return };
    let mut text = String::from(
        "[image]\nwidth = 80\nheight = 60\n[camera]\nposition = [0, 0, 3]\n[materials.m]\nbase_color = [1, 0, 0]\n",
    );
    for i in 0..10_000 {
        let (x, y) = (f64::from(i % 100) * 0.02 - 1.0, f64::from(i / 100) * 0.02 - 1.0);
        text += &format!("[[objects]]\nmesh = \"quad\"\nscale = 0.008\ntranslate = [{x:.2}, {y:.2}, 0]\n");
    }
    room.write("many.toml", text);
    ok(&room, "render many.toml -o many.png --backend gpu");
    assert_eq!(room.picture("many.png").dimensions(), (80, 60));
}
