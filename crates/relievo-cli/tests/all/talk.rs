//! Messages of the binary: help, notes, completions, and how it takes being cut off.

use std::process::Stdio;

use crate::room::Room;

#[test]
fn every_help_text_has_an_example_and_fits_a_terminal() {
    let room = Room::new();
    let view = cfg!(feature = "view").then_some("view");
    for command in ["", "render", "compare", "lab", "tune", "devices", "completions"].into_iter().chain(view) {
        let help = room.ok(&format!("{command} --help")).stdout;
        assert!(help.contains("Example"), "{command}");
        assert!(help.contains(&format!("\n  relievo {command}")), "{command}: {help}");
        let widest = help.lines().map(|line| line.chars().count()).max().unwrap();
        assert!(widest <= 100, "{command}: {widest}");
        // A wrapped example could not be copied.
        let examples = help.lines().skip_while(|line| !line.starts_with("Example")).skip(1);
        for line in examples.take_while(|line| !line.is_empty()) {
            assert!(line.starts_with("  relievo "), "{command}: {line}");
        }
    }
    assert!(room.ok("--help").stdout.contains("Exit codes: 0 done, 1 failed, 2 wrong usage"));
    assert_eq!(room.ok("help render").stdout, room.ok("render --help").stdout);
}

#[test]
fn examples_in_help_are_accepted() {
    let room = Room::new();
    for scene in ["wall", "sphere", "drifting-clouds"] {
        room.write(&format!("scenes/{scene}.toml"), crate::room::SCENE);
    }
    let mut count = 0;
    for command in ["", "render", "compare"] {
        let help = room.ok(&format!("{command} --help")).stdout;
        for line in help.lines().filter_map(|line| line.strip_prefix("  relievo ")) {
            // What follows many spaces is an explanation.
            let example = line.split("   ").next().unwrap();
            // As a shell would split them.
            let mut arguments: Vec<String> = Vec::new();
            for (i, part) in example.split('\'').enumerate() {
                if i % 2 == 1 {
                    arguments.last_mut().unwrap().push_str(part);
                } else {
                    arguments.extend(part.split(' ').filter(|word| !word.is_empty()).map(str::to_owned));
                }
            }
            if arguments[0] == "view" {
                // It has tests of its own, where there is a display.
                continue;
            }
            if arguments[0] == "tune" {
                arguments.extend(["--size", "32", "--rays", "64"].map(str::to_owned));
            }
            if ["render", "compare"].contains(&arguments[0].as_str()) {
                let small = ["--make-size", "16", "--samples", "1", "--size", "16x12"].map(str::to_owned);
                let has_size = arguments.iter().any(|argument| argument == "--size");
                arguments.extend(small.into_iter().take(if has_size { 4 } else { 6 }));
                arguments.iter_mut().filter(|argument| *argument == "1280x720").for_each(|size| *size = "16x12".into());
            }
            let outcome = room.run(&arguments);
            assert_eq!(outcome.code, Some(0), "{example}: {}", outcome.stderr);
            count += 1;
        }
    }
    assert!(count >= 8, "{count}");
}

#[test]
fn nothing_asked_shows_the_help_as_wrong_usage() {
    let outcome = Room::new().run([""; 0]);
    assert_eq!(outcome.code, Some(2));
    assert!(outcome.stderr.contains("Usage: relievo") && outcome.stdout.is_empty(), "{outcome:?}");
}

#[test]
fn the_backend_is_told_with_the_reason() {
    let room = Room::new();
    let auto = room.ok("render scene.toml -o out.png --make-size 16 --threads 2");
    let why = if cfg!(feature = "gpu") { "there is no GPU adapter" } else { "this build has no GPU backend" };
    assert_eq!(auto.stderr, format!("note: drawing on the CPU with 2 threads: {why}\n"));
    let cpu = room.ok("render scene.toml -o out.png --make-size 16 --threads 1 --backend cpu");
    assert_eq!(cpu.stderr, "note: drawing on the CPU with 1 thread, as asked\n");
}

#[test]
fn what_is_odd_in_a_scene_is_noted() {
    let room = Room::new();
    let outcome = room.ok("render scene.toml -o out.png --make-size 16 --set lights=[]");
    assert!(outcome.stderr.contains("note: the scene has no [[lights]]"), "{}", outcome.stderr);
}

#[test]
fn quiet_says_nothing_but_errors() {
    let room = Room::new();
    for run in [
        "-q render scene.toml -o out.png --make-size 16 --set lights=[]",
        "render scene.toml -o out.png --make-size 16 --quiet --aov hit=h.png --stats s.json",
        "compare scene.toml -o out.png --make-size 16 --size 8x8 --techniques none --quiet --json s.json",
    ] {
        let outcome = room.ok(run);
        assert_eq!((outcome.stdout.as_str(), outcome.stderr.as_str()), ("", ""), "{run}");
    }
    let outcome = room.run(["render", "no.toml", "-o", "out.png", "--quiet"]);
    assert_eq!(outcome.stderr.lines().count(), 1);
    assert!(outcome.stderr.starts_with("error: no.toml: "), "{}", outcome.stderr);
}

#[test]
fn completions_know_the_commands_and_their_options() {
    let room = Room::new();
    for shell in ["bash", "zsh", "fish"] {
        let script = room.ok(&format!("completions {shell}")).stdout;
        for word in ["relievo", "render", "compare", "completions", "technique", "occlusion", "truth-grid"] {
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
}

#[test]
fn a_reader_that_has_seen_enough_is_no_error() {
    let room = Room::new();
    for run in ["completions bash", "--help", "compare scene.toml --make-size 16 --size 8x8 --techniques none --json -"]
    {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let mut command = room.command(run.split(' '));
        let output = command.stdout(writer).stderr(Stdio::piped()).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{run}");
        assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{run}");
    }
}

#[test]
fn the_version_is_the_packages() {
    assert_eq!(Room::new().ok("--version").stdout, format!("relievo {}\n", env!("CARGO_PKG_VERSION")));
}
