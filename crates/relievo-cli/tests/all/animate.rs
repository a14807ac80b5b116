//! `relievo render --time` and `--animate`.

use std::fs::File;
use std::io::BufReader;

use image::AnimationDecoder;
use image::codecs::png::PngDecoder;
use image::codecs::webp::WebPDecoder;

use crate::room::{KNOWN, Room};

/// Clouds that change and drift under a camera that moves, in a loop of one second.
const FILM: &str = r#"
[image]
width = 40
height = 30
[time]
loop = 1
[camera]
position = [0, 1, 2]
[[lights]]
kind = "directional"
direction = [-0.7, -0.5, -0.55]
[materials.clouds]
height = "make:clouds"
height_size = 32
uv_velocity = [1, 0]
[[objects]]
mesh = "plane"
[[animate]]
key = "camera.position"
keys = [{ time = 0, value = [0, 1, 2] }, { time = 0.5, value = [0.3, 1, 2] }, { time = 1, value = [0, 1, 2] }]
"#;

fn room() -> Room {
    let room = Room::new();
    room.write("film.toml", FILM);
    room
}

fn frames(room: &Room) -> Vec<String> {
    room.names().into_iter().filter(|name| name.starts_with("frames/") && name.ends_with(".png")).collect()
}

#[test]
fn a_frame_drawn_alone_is_the_frame_of_the_animation_with_any_number_of_threads() {
    let room = room();
    for (folder, threads) in [("one", 1), ("many", 5)] {
        room.ok(&format!("render film.toml --animate 0..1 --fps 6 -o {folder}/%02d.png --threads {threads}"));
    }
    for number in 0..6 {
        let name = format!("{number:02}.png");
        let seconds = f64::from(number) / 6.0;
        room.ok(&format!("render film.toml --time {seconds} -o alone.png"));
        let alone = room.read("alone.png");
        assert!(room.read(&format!("one/{name}")) == alone && room.read(&format!("many/{name}")) == alone, "{name}");
    }
    // The frame after the last is the first, and none is its neighbour.
    room.ok("render film.toml --time 1 -o alone.png");
    assert!(room.read("alone.png") == room.read("one/00.png"));
    for number in 0..6 {
        assert!(room.read(&format!("one/{number:02}.png")) != room.read(&format!("one/{:02}.png", (number + 1) % 6)));
    }
}

#[test]
fn films_hold_the_frames_and_play_for_ever() {
    let room = room();
    room.ok("render film.toml --animate 0..1 --fps 5 -o frames/%d.png");
    for name in ["loop.apng", "loop.webp"] {
        room.ok(&format!("render film.toml --animate 0..1 --fps 5 -o {name} --threads 2"));
        let file = || BufReader::new(File::open(room.path(name)).unwrap());
        let frames = if name.ends_with("apng") {
            PngDecoder::new(file()).unwrap().apng().unwrap().into_frames().collect_frames()
        } else {
            WebPDecoder::new(file()).unwrap().into_frames().collect_frames()
        };
        let frames = frames.unwrap();
        assert_eq!(frames.len(), 5);
        for (number, frame) in frames.iter().enumerate() {
            assert_eq!(frame.delay().numer_denom_ms(), (200, 1));
            let expected = room.picture(&format!("frames/{number}.png"));
            assert!(frame.buffer().pixels().zip(expected.pixels()).all(|(a, b)| a.0[..3] == b.0), "{name} {number}");
        }
        let bytes = room.read(name);
        room.ok(&format!("render film.toml --animate 0..1 --fps 5 -o {name} --threads 1"));
        assert!(room.read(name) == bytes, "{name}: the same bytes with one thread");
    }
}

#[test]
fn an_animation_goes_on_where_it_was_left_and_begins_anew_when_anything_changed() {
    let room = room();
    let animate = |more: &str| {
        room.ok(&format!("render film.toml --animate 0..1 --fps 4 -o frames/%d.png --threads 2 {more}")).stderr
    };
    animate("");
    assert_eq!(frames(&room), ["frames/0.png", "frames/1.png", "frames/2.png", "frames/3.png"]);
    let third = room.read("frames/2.png");
    room.remove("frames/2.png");
    room.write("frames/1.png", KNOWN);
    let said = animate("");
    assert!(said.contains("3 frames were drawn before, as frames/relievo-manifest.json says"), "{said}");
    // What is there is left alone, what is not is drawn as it was.
    assert!(room.read("frames/2.png") == third && room.read("frames/1.png") == KNOWN);
    let said = animate("--set camera.vertical_fov=30");
    assert!(!said.contains("drawn before") && room.read("frames/1.png") != KNOWN, "{said}");
    assert!(animate("--size 20x10").contains("drawing on"));
    assert!(!animate("--size 20x10 --technique steep").contains("drawn before"));
    room.write("film.toml", FILM.replace("0.55]", "0.5]"));
    assert!(!animate("").contains("drawn before"), "the scene file changed");
    assert!(animate("").contains("4 frames were drawn before"));
}

#[cfg(target_os = "linux")]
#[test]
fn a_disk_that_fills_keeps_the_finished_frames_and_leaves_no_half_ones() {
    let room = room();
    room.write("frames/x", "");
    std::os::unix::fs::symlink("/dev/full", room.path("frames/2.png")).unwrap();
    let arguments = ["render", "film.toml", "--animate", "0..1", "--fps", "5", "-o", "frames/%d.png", "--threads", "1"];
    let outcome = room.run(arguments);
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("error: frames/2.png: cannot write the file: No space left"), "{}", outcome.stderr);
    assert_eq!(frames(&room), ["frames/0.png", "frames/1.png", "frames/2.png"]);
    assert!(!room.names().iter().any(|name| name.contains(".part")), "{:?}", room.names());
    let first = room.read("frames/0.png");
    room.remove("frames/2.png");
    let outcome = room.ok(&arguments.join(" "));
    assert!(outcome.stderr.contains("2 frames were drawn before"), "{}", outcome.stderr);
    assert!(frames(&room).len() == 5 && room.read("frames/0.png") == first);
}

#[test]
fn wrong_animations_say_what_is_wrong() {
    let room = room();
    for (arguments, code, says) in [
        (
            "film.toml --animate 0..1 --fps 0 -o frames/%d.png",
            2,
            "expected frames per second, above 0 and at most 1000",
        ),
        ("film.toml --animate 0..1 --fps nan -o frames/%d.png", 2, "expected frames per second"),
        ("film.toml --animate 0..1 --fps -3 -o frames/%d.png", 2, "expected frames per second"),
        ("film.toml --animate 0..1 -o frame.png", 2, "with the number's place in its name as in frames/%04d.png"),
        ("film.toml --animate 0..1 -o frames/%d-%d.png", 2, "there is one number in the name"),
        ("film.toml --animate 1..1 -o frames/%d.png", 2, "an animation of length 0 has no frames"),
        ("film.toml --animate 2..1 -o frames/%d.png", 2, "the first before the last"),
        ("film.toml --animate x -o frames/%d.png", 2, "as in 0..4"),
        ("film.toml --animate 0..1e6 --fps 1000 -o frames/%d.png", 2, "1 to 1000000 are drawn"),
        ("film.toml --fps 3 -o out.png", 2, "--animate"),
        ("film.toml -o loop.apng", 2, "say which with --animate"),
        ("film.toml --time nan -o out.png", 2, "expected a number of seconds"),
        ("film.toml --time 1 --animate 0..1 -o frames/%d.png", 2, "cannot be used with"),
        ("film.toml --animate 0..1 -o no/such/%d.png", 1, "make it first"),
        ("film.toml --animate 0..1 -o out.png/%d.png", 1, "this is a file"),
        ("film.toml --animate 0..1 -o no/loop.webp", 1, "there is no folder"),
        ("film.toml --set time.loop=0 -o out.png", 2, "a loop of length 0 has no frames"),
    ] {
        let outcome = room.run(format!("render {arguments}").split_whitespace());
        assert!(outcome.code == Some(code) && outcome.stderr.contains(says), "{arguments}: {outcome:?}");
    }
    assert_eq!(room.read("out.png"), KNOWN);
    assert_eq!(room.names(), ["film.toml", "out.png", "scene.toml"]);
    // A scene that cannot be drawn at some time says at which; what came before stays.
    room.write(
        "film.toml",
        FILM.replace("value = [0.3, 1, 2] }", "value = [0, 0, 0] }")
            .replace("[[animate]]", "[[animate]]\ninterpolation = \"linear\""),
    );
    let outcome = room.run("render film.toml --animate 0..1 --fps 4 -o frames/%d.png".split_whitespace());
    assert!(
        outcome.stderr.contains("film.toml:25: [camera] position and target are the same point")
            || outcome.stderr.contains("are the same point"),
        "{}",
        outcome.stderr
    );
    let outcome = room.ok("render scene.toml --make-size 16 --animate 0..1 --fps 2 -o frames/%d.png");
    assert!(outcome.stderr.contains("nothing in the scene changes with time"), "{}", outcome.stderr);
}

#[cfg(feature = "gpu")]
#[test]
fn a_film_on_a_gpu_is_that_of_the_cpu() {
    let room = room();
    let outcome = room.run_with_gpus("render film.toml --animate 0..1 --fps 4 -o gpu/%d.png --backend gpu");
    if outcome.code != Some(0) {
        assert!(std::env::var_os("RELIEVO_REQUIRE_ADAPTER").is_none(), "{}", outcome.stderr);
        eprintln!("skipped: no adapter");
        return;
    }
    room.ok("render film.toml --animate 0..1 --fps 4 -o cpu/%d.png");
    for number in 0..4 {
        let [a, b] = ["gpu", "cpu"].map(|folder| room.picture(&format!("{folder}/{number}.png")));
        let steps = a.as_raw().iter().zip(b.as_raw()).map(|(a, b)| f64::from(a.abs_diff(*b)));
        let mean = steps.sum::<f64>() / a.as_raw().len() as f64;
        assert!(mean <= 1.0, "{number}: {mean}");
    }
}
