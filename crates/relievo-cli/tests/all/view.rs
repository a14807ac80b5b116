//! `relievo view`: a window on a display of its own, played by scripts. What it shows is compared with what `relievo render`
//! draws for the same state. Skipped where there is no Xvfb or no GPU adapter, unless `RELIEVO_REQUIRE_DISPLAY` and
//! `RELIEVO_REQUIRE_ADAPTER` say that there must be.

use std::fs;
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use image::RgbImage;
use relievo_scene::SurfaceTechnique;
use tempfile::TempDir;

use crate::room::{Outcome, Room};

/// A session that draws a hundred pictures in software on a busy machine takes a while.
const PATIENCE: Duration = Duration::from_secs(240);

/// Tolerance between a window's picture and the CPU's: the mean difference, and the part of the pixels that differ by more
/// than 8, in steps of 255.
const TOLERANCE: (f64, f64) = (1.0, 0.005);

/// The same for displaced geometry: the GPU shadows it through a map of its own, the CPU by rays.
const DISPLACED: (f64, f64) = (2.0, 0.04);

/// A program that ends with the test, however that ends.
struct Running(Child);

/// An X server without a screen.
struct Display {
    _server: Running,
    name: String,
    /// The folder in which the server keeps what would be on the screen.
    memory: TempDir,
}

impl Display {
    /// `None` where there is no Xvfb and there need not be one.
    fn start() -> Option<Self> {
        let required = std::env::var_os("RELIEVO_REQUIRE_DISPLAY").is_some();
        let mut command = Command::new("Xvfb");
        // It looks for a free number by itself and tells it on stdout.
        command.args(["-displayfd", "1", "-screen", "0", "1280x1024x24", "-nolisten", "tcp", "-fbdir"]);
        let memory = tempfile::tempdir().unwrap();
        command.arg(memory.path());
        let server = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn();
        let mut server = match server {
            Ok(server) => server,
            Err(error) if required => panic!("RELIEVO_REQUIRE_DISPLAY is set, but Xvfb does not start: {error}"),
            Err(error) => {
                eprintln!("skipped: Xvfb does not start: {error}");
                return None;
            }
        };
        let mut number = String::new();
        BufReader::new(server.stdout.take().unwrap()).read_line(&mut number).unwrap();
        Some(Self { _server: Running(server), name: format!(":{}", number.trim()), memory })
    }

    /// The upper left corner of the screen.
    fn screen(&self, width: u32, height: u32) -> RgbImage {
        // An X window dump: a header of big-endian numbers, a palette of 12 bytes each, rows of BGRX.
        let bytes = fs::read(self.memory.path().join("Xvfb_screen0")).unwrap();
        let number = |k: usize| u32::from_be_bytes(bytes[4 * k..][..4].try_into().unwrap()) as usize;
        let (pixels, row) = (number(0) + 12 * number(19), number(12));
        RgbImage::from_fn(width, height, |x, y| {
            let at = pixels + y as usize * row + 4 * x as usize;
            image::Rgb([bytes[at + 2], bytes[at + 1], bytes[at]])
        })
    }

    fn view(&self, room: &Room, arguments: &str) -> Command {
        let mut command = room.command(arguments.split_whitespace());
        command.env("DISPLAY", &self.name).env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
        command.env_remove("WGPU_BACKEND");
        command
    }

    /// Runs a session; `None` if there is no adapter and there need not be one.
    fn session(&self, room: &Room, arguments: &str) -> Option<Outcome> {
        let outcome = room.run_command(self.view(room, arguments), PATIENCE);
        if outcome.stderr.contains("no GPU adapter was found") && std::env::var_os("RELIEVO_REQUIRE_ADAPTER").is_none()
        {
            eprintln!("skipped: {}", outcome.stderr);
            return None;
        }
        assert_eq!(outcome.code, Some(0), "{arguments}: {}\n{}", outcome.stderr, outcome.stdout);
        Some(outcome)
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// The mean difference of two pictures, and the part of the pixels that differ by more than 8.
fn difference(a: &RgbImage, b: &RgbImage) -> (f64, f64) {
    assert_eq!(a.dimensions(), b.dimensions());
    let apart = |(a, b): (&image::Rgb<u8>, &image::Rgb<u8>)| [0, 1, 2].map(|k| a[k].abs_diff(b[k]));
    let (mut sum, mut over) = (0.0, 0);
    for steps in a.pixels().zip(b.pixels()).map(apart) {
        sum += steps.iter().map(|&step| f64::from(step)).sum::<f64>() / 3.0;
        over += usize::from(steps.iter().any(|&step| step > 8));
    }
    let count = f64::from(a.width() * a.height());
    (sum / count, over as f64 / count)
}

fn same(a: &RgbImage, b: &RgbImage, tolerance: (f64, f64)) -> bool {
    let (mean, over) = difference(a, b);
    mean <= tolerance.0 && over <= tolerance.1
}

/// The words of a command as a shell would take them apart, for what the window prints: quotes begin and end words.
fn words(line: &str) -> Vec<String> {
    let mut words = Vec::new();
    for (number, part) in line.split('\'').enumerate() {
        if number % 2 == 1 {
            words.push(part.to_owned());
        } else {
            words.extend(part.split_whitespace().map(str::to_owned));
        }
    }
    words
}

#[test]
fn all_that_a_window_says_is_ours() {
    let (Some(display), room) = (Display::start(), Room::new()) else { return };
    let Some(outcome) = display.session(&room, "view scene.toml --make-size 16 --frames 2") else { return };
    outcome.assert_only_notes();
}

#[test]
fn a_session_shows_what_render_draws_for_every_state() {
    let (Some(display), room) = (Display::start(), Room::new()) else { return };
    let mut script = String::new();
    let mut shots = Vec::new();
    let mut shoot = |script: &mut String, name: &str| {
        script.push_str(&format!("screenshot {name}.png\nkey P\n"));
        shots.push(name.to_owned());
    };
    shoot(&mut script, "start");
    script.push_str("drag left 60 -30\nwheel 1\ndrag right 5 10\nhold W 6\nhold A 3\n");
    shoot(&mut script, "moved");
    let names: Vec<&str> = SurfaceTechnique::names().collect();
    for (number, name) in names.iter().enumerate() {
        let shift = if number < 10 { "" } else { "shift+" };
        script.push_str(&format!("key {shift}{}\n", (number + 1) % 10));
        shoot(&mut script, name);
    }
    script.push_str("key shift+2\nkey E 6\n");
    shoot(&mut script, "high");
    script.push_str("key Q 6\n");
    shoot(&mut script, "as-before");
    for shadow in ["none", "hard", "soft", "exact"] {
        script.push_str("key O\n");
        shoot(&mut script, &format!("shadow-{shadow}"));
    }
    script.push_str("drag ctrl+left 80 40\n");
    shoot(&mut script, "light");
    script.push_str("key G\n");
    shoot(&mut script, "edge");
    script.push_str("wheel -9\nkey M 5\n");
    shoot(&mut script, "torus");
    script.push_str("key shift+Home\n");
    shoot(&mut script, "reset");
    script.push_str("resize 90x70\n");
    shoot(&mut script, "resized");
    script.push_str("key F12\ntitle\nquit\nscreenshot never.png\n");
    room.write("session.txt", &script);
    room.write("shots/scene-001.png", "not to be overwritten");

    let run = "view scene.toml --size 160x120 --make-size 64 --script session.txt --screenshots shots";
    let Some(outcome) = display.session(&room, run) else { return };
    let commands: Vec<&str> = outcome.stdout.lines().filter(|line| line.starts_with("relievo render ")).collect();
    assert_eq!(commands.len(), shots.len(), "{}", outcome.stdout);

    let shot = |name: &str| room.picture(&format!("shots/{name}.png"));
    for (name, command) in shots.iter().zip(commands) {
        let drawn = room.run(words(command).into_iter().skip(1).chain(["--backend", "cpu"].map(str::to_owned)));
        assert_eq!(drawn.code, Some(0), "{command}: {}", drawn.stderr);
        let (seen, drawn) = (shot(name), room.picture("picture.png"));
        let tolerance = if name == "displacement" { DISPLACED } else { TOLERANCE };
        if !same(&seen, &drawn, tolerance) {
            let kept = std::env::temp_dir().join(format!("relievo-view-{}-{name}", std::process::id()));
            seen.save(kept.with_extension("seen.png")).unwrap();
            drawn.save(kept.with_extension("drawn.png")).unwrap();
            panic!("{name}: {:?}, see {}*\n{command}", difference(&seen, &drawn), kept.display());
        }
    }

    // A comparison that cannot fail would say the same of these.
    let before = shot("exact");
    for other in ["start", "high", "light", "edge", "torus", "shadow-none", "shadow-hard"] {
        assert!(!same(&before, &shot(other), TOLERANCE), "{other} shows the same");
    }
    for (number, a) in names.iter().enumerate() {
        for b in &names[..number] {
            // Cones find what the exact march finds.
            if (*b, *a) != ("cone", "exact") {
                assert_ne!(shot(a), shot(b), "{a} and {b} show the same");
            }
        }
    }
    assert_eq!(shot("as-before"), before);
    assert_eq!(shot("shadow-exact"), before);
    assert_eq!(shot("reset"), shot("start"));
    assert_eq!(shot("resized").dimensions(), (90, 70));

    assert_eq!(room.read("shots/scene-001.png"), b"not to be overwritten");
    assert_eq!(shot("scene-002"), shot("resized"));
    assert!(!room.path("shots/never.png").exists());
    let title = outcome.stdout.lines().last().unwrap();
    assert!(title.starts_with("Relievo: scene | exact, shadow exact | ") && title.ends_with(" | 90×70"), "{title}");
    let fetches: f64 =
        title.split(" | ").find_map(|part| part.strip_suffix(" fetches per pixel")).unwrap().parse().unwrap();
    assert!(fetches > 1.0 && title.contains(" ms "), "{title}");
}

/// A scene in which a camera, heights and maps move; it begins anew after a second.
const FILM: &str = r#"
[image]
width = 120
height = 90
[time]
loop = 1
[camera]
position = [0, 1, 2]
[[lights]]
kind = "directional"
direction = [-0.7, -0.5, -0.55]
[materials.clouds]
height = "make:clouds"
height_size = 64
uv_velocity = [1, 0]
[[objects]]
mesh = "plane"
[[animate]]
key = "camera.position"
keys = [{ time = 0, value = [0, 1, 2] }, { time = 0.5, value = [0.3, 1, 2] }, { time = 1, value = [0, 1, 2] }]
"#;

#[test]
fn time_plays_pauses_steps_and_is_scrubbed_to_what_render_draws_at_that_time() {
    let (Some(display), room) = (Display::start(), Room::new()) else { return };
    room.write("film.toml", FILM);
    let mut script = String::new();
    let mut shots = Vec::new();
    let mut shoot = |script: &mut String, before: &str, name: &'static str| {
        script.push_str(&format!("{before}screenshot {name}.png\nkey P\n"));
        shots.push(name);
    };
    shoot(&mut script, "", "start");
    shoot(&mut script, "key Space\nframes 9\n", "playing");
    shoot(&mut script, "key Space\nframes 5\n", "paused");
    shoot(&mut script, "frames 5\n", "still");
    shoot(&mut script, "key Period 6\n", "stepped");
    shoot(&mut script, "hold Left 8\n", "scrubbed");
    shoot(&mut script, "key shift+Period\n", "next-loop");
    // Changes made by hand stay while time goes on.
    shoot(&mut script, "key E 4\ndrag left 40 10\nkey Space\nframes 4\nkey Space\n", "changed");
    script.push_str("title\n");
    room.write("session.txt", &script);
    let Some(outcome) = display.session(&room, "view film.toml --script session.txt") else { return };
    let commands: Vec<&str> = outcome.stdout.lines().filter(|line| line.starts_with("relievo render ")).collect();
    assert_eq!(commands.len(), shots.len(), "{}", outcome.stdout);
    for (name, command) in shots.iter().zip(&commands) {
        let drawn = room.run(words(command).into_iter().skip(1).chain(["--backend", "cpu"].map(str::to_owned)));
        assert_eq!(drawn.code, Some(0), "{command}: {}", drawn.stderr);
        let (seen, drawn) = (room.picture(&format!("{name}.png")), room.picture("picture.png"));
        assert!(same(&seen, &drawn, TOLERANCE), "{name}: {:?}\n{command}", difference(&seen, &drawn));
    }
    let shot = |name: &str| room.picture(&format!("{name}.png"));
    assert_eq!(shot("paused"), shot("still"));
    assert_eq!(shot("scrubbed"), shot("next-loop"));
    for (a, b) in [("start", "playing"), ("playing", "stepped"), ("stepped", "scrubbed"), ("next-loop", "changed")] {
        assert!(!same(&shot(a), &shot(b), TOLERANCE), "{a} and {b} show the same");
    }
    let title = outcome.stdout.lines().last().unwrap();
    assert!(title.contains(" s | 120×90"), "{title}");
    // A scene that stands still says so.
    room.write("session.txt", "key Space\nframes 2\n");
    let Some(outcome) = display.session(&room, "view scene.toml --make-size 16 --script session.txt") else { return };
    assert!(outcome.stderr.contains("note: nothing in the scene changes with time"), "{}", outcome.stderr);
}

#[test]
fn what_is_on_the_screen_is_what_the_screenshot_shows() {
    let (Some(display), room) = (Display::start(), Room::new()) else { return };
    let run = "view scene.toml --size 90x70 --make-size 64 --script session.txt";
    room.write("session.txt", "key 6\nscreenshot one.png");
    if display.session(&room, run).is_none() {
        return;
    }
    room.write("session.txt", "key 6\ndrag left 30 0\nscreenshot two.png\nframes 1000000");
    let window = display.view(&room, run).stdout(Stdio::null()).stderr(Stdio::null()).spawn();
    let mut window = Running(window.unwrap());
    let start = Instant::now();
    let shown = || room.path("two.png").exists().then(|| room.picture("two.png"));
    while shown().is_none_or(|shown| shown != display.screen(90, 70)) {
        assert!(window.0.try_wait().unwrap().is_none() && start.elapsed() < PATIENCE, "the screen never shows it");
        std::thread::sleep(Duration::from_millis(20));
    }
    assert_ne!(display.screen(90, 70), room.picture("one.png"));
}

#[test]
fn a_lost_device_is_opened_anew() {
    let (Some(display), room) = (Display::start(), Room::new()) else { return };
    let script =
        "screenshot a.png\nlose-device\nframes 2\nscreenshot b.png\nlose-device\nkey 1\nlose-device\nscreenshot c.png";
    room.write("session.txt", script);
    let Some(outcome) = display.session(&room, "view scene.toml --make-size 16 --script session.txt") else { return };
    assert_eq!(outcome.stderr.matches("the GPU was lost").count(), 3, "{}", outcome.stderr);
    assert_eq!(room.picture("a.png"), room.picture("b.png"));
    assert_ne!(room.picture("a.png"), room.picture("c.png"));
}

#[test]
fn frames_are_counted_and_timed() {
    let (Some(display), room) = (Display::start(), Room::new()) else { return };
    let Some(outcome) = display.session(&room, "view scene.toml --make-size 16 --frames 7") else { return };
    let line = outcome.stdout.trim_end();
    assert!(line.starts_with("7 frames (") && line.contains("median ") && line.ends_with(" ms"), "{line}");

    room.write("session.txt", "frames 3\n\nframes 30\n");
    let run = "view scene.toml --make-size 16 --frames 7 --script session.txt";
    let outcome = room.run_command(display.view(&room, run), PATIENCE);
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("error: session.txt:3: the 7 frames of --frames were over"), "{}", outcome.stderr);
}

#[test]
fn a_changed_file_is_shown_and_a_broken_one_is_told() {
    let (Some(display), room) = (Display::start(), Room::new()) else { return };
    if display.session(&room, "view scene.toml --make-size 16 --frames 1").is_none() {
        return;
    }
    let mut command = display.view(&room, "view scene.toml --make-size 16 --frames 1000000");
    command.stdout(Stdio::null()).stderr(fs::File::create(room.path("said")).unwrap());
    let mut window = Running(command.spawn().unwrap());
    let start = Instant::now();
    let mut wait_for = |text: &str| {
        while !fs::read_to_string(room.path("said")).unwrap().contains(text) {
            assert!(window.0.try_wait().unwrap().is_none() && start.elapsed() < PATIENCE, "it never said \"{text}\"");
            std::thread::sleep(Duration::from_millis(50));
        }
    };
    wait_for("drawing on");
    room.write("scene.toml", "[camera]\nfov = 3\n");
    wait_for("error: scene.toml:2: unknown key \"fov\"");
    room.write("scene.toml", format!("{}\nuv_repeat = 2\n", crate::room::SCENE));
    wait_for("note: the scene was loaded again");
}

#[test]
fn without_a_display_it_says_so_and_names_render() {
    let room = Room::new();
    for display in [None, Some(":9999"), Some("nonsense")] {
        let mut command = room.command(["view", "scene.toml", "--make-size", "16"]);
        command.env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET").env_remove("DISPLAY");
        if let Some(display) = display {
            command.env("DISPLAY", display);
        }
        let outcome = room.run_command(command, PATIENCE);
        assert_eq!(outcome.code, Some(1), "{display:?}: {}", outcome.stderr);
        assert_eq!(outcome.stderr.lines().count(), 1, "{}", outcome.stderr);
        assert!(outcome.stderr.starts_with("error: there is no display to open a window on ("), "{}", outcome.stderr);
        assert!(outcome.stderr.contains("`relievo render` draws the same scene into a file"), "{}", outcome.stderr);
    }
}

#[test]
fn without_the_adapter_it_says_what_there_is() {
    let (Some(display), room) = (Display::start(), Room::new()) else { return };
    let mut command = display.view(&room, "view scene.toml --make-size 16 --frames 1");
    // No driver's description, and no other interface to try.
    command
        .env("VK_ICD_FILENAMES", "/nowhere.json")
        .env("VK_DRIVER_FILES", "/nowhere.json")
        .env("WGPU_BACKEND", "vulkan");
    let outcome = room.run_command(command, PATIENCE);
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("no GPU adapter was found: install a driver"), "{}", outcome.stderr);

    let command = display.view(&room, "view scene.toml --make-size 16 --frames 1 --adapter nosuchthing");
    let outcome = room.run_command(command, PATIENCE);
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("adapter"), "{}", outcome.stderr);
}

#[test]
fn what_is_wrong_with_a_script_is_said_with_its_line() {
    let room = Room::new();
    room.write("bad.txt", "frames 2\n# a comment\njump\n");
    room.write("binary.txt", [0xff, 0xfe, 0x00]);
    for (run, expected) in [
        ("--script bad.txt", "error: bad.txt:3: \"jump\" is not a step: key, hold, drag"),
        ("--script binary.txt", "error: binary.txt: cannot read the script: "),
        ("--script none.txt", "error: none.txt: cannot read the script: "),
        ("--script .", "error: .: cannot read the script: "),
    ] {
        let outcome = room.run(format!("view scene.toml --make-size 16 {run}").split_whitespace());
        assert_eq!(outcome.code, Some(1), "{run}: {}", outcome.stderr);
        assert!(outcome.stderr.starts_with(expected), "{}", outcome.stderr);
    }
    let outcome = room.run("view scene.toml --make-size 16 --screenshots nowhere".split_whitespace());
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("--screenshots nowhere: there is no such folder"), "{}", outcome.stderr);
}
