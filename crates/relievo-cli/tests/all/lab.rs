//! `relievo lab` and `relievo tune`: what they write, what they say, how they refuse.

use crate::files::png;
use crate::room::Room;

/// Small enough for a test.
const SMALL: &str = "--size 32 --rays 64 --angles 0,75 --depths 10 --minify 1 --techniques tutorials,exact,exact:cells \
                     --picture-size 24x18 --picture-angles 60 --picture-minify 1 --backend cpu";

#[test]
fn a_report_is_written_and_a_second_run_skips_what_is_done() {
    let room = Room::new();
    let first = room.ok(&format!("lab spikes make:toy-box -o out {SMALL}"));
    assert!(first.stdout.is_empty() && first.stderr.contains("note: wrote out"), "{}", first.stderr);
    for file in ["report.html", "results.json", "hits.csv", "pictures.csv", "summary.md", "relievo-manifest.json"] {
        assert!(!room.read(&format!("out/{file}")).is_empty(), "{file}");
    }
    let json = room.json("out/results.json");
    assert_eq!(json["materials"][1]["name"], "toy-box");
    assert_eq!(json["hits"].as_array().unwrap().len(), 2 * 2 * 3);
    // What NVIDIA's FLIP is run over: pairs of pictures with our mean beside them.
    for row in json["pictures"].as_array().unwrap() {
        assert!(row["flip"].as_f64().unwrap() >= 0.0);
        for key in ["picture", "truth"] {
            let picture = room.picture(&format!("out/{}", row[key].as_str().unwrap()));
            assert_eq!(picture.dimensions(), (24, 18));
        }
    }
    let page = room.read("out/report.html");
    let again = room.ok(&format!("lab spikes make:toy-box -o out {SMALL}"));
    assert!(again.stderr.contains("4 cases were done before"), "{}", again.stderr);
    assert_eq!(room.read("out/report.html"), page);
    let quiet = room.ok(&format!("lab spikes make:toy-box -o out {SMALL} --quiet"));
    assert_eq!((quiet.stdout.as_str(), quiet.stderr.as_str()), ("", ""));
}

#[test]
fn folders_and_files_are_judged_too_and_a_missing_gpu_is_said() {
    let room = Room::new();
    room.ok("map make cobbles -o stones --size 32");
    let small = SMALL.replace("--backend cpu", "--backend both");
    let outcome = room.ok(&format!("lab stones stones/cobbles_Displacement.png -o out {small} --no-pictures"));
    assert!(outcome.stderr.contains("measuring the CPU alone"), "{}", outcome.stderr);
    let json = room.json("out/results.json");
    let names: Vec<&str> = json["materials"].as_array().unwrap().iter().map(|m| m["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["stones", "cobbles_Displacement"]);
    assert!(json["pictures"].as_array().unwrap().is_empty() && json["machine"]["adapter"].is_null());
}

#[track_caller]
fn refused(arguments: &str, code: i32, says: &[&str]) {
    let room = Room::new();
    room.write("flat.png", png(4, 4));
    let before = room.names();
    let outcome = room.run(arguments.split(' '));
    assert_eq!(outcome.code, Some(code), "{arguments}: {outcome:?}");
    for fragment in says {
        assert!(outcome.stderr.contains(fragment), "{arguments}: {}", outcome.stderr);
    }
    // A note may say first that there is no GPU.
    let first = outcome.stderr.lines().find(|line| !line.starts_with("note: "));
    assert!(first.is_some_and(|line| line.starts_with("error: ")) && outcome.stdout.is_empty(), "{outcome:?}");
    assert_eq!(room.names(), before, "{arguments}");
}

#[test]
fn what_the_lab_cannot_measure_is_refused() {
    refused("lab", 2, &["MATERIAL"]);
    refused("lab spikes", 2, &["--output"]);
    refused("lab no-such -o out", 1, &["no-such: there is no such file or folder", "spikes"]);
    refused("lab make:cobles -o out", 1, &["did you mean \"cobbles\"?"]);
    refused("lab scene.toml -o out", 1, &["scene.toml"]);
    refused("lab spikes spikes -o out", 1, &["two materials are called spikes"]);
    refused("lab spikes -o scene.toml", 1, &["scene.toml: this is a file"]);
    refused("lab spikes -o no/such", 1, &["make it first"]);
    refused("lab spikes -o out --angles 90", 2, &["expected a number from 0 to 89.9"]);
    refused("lab spikes -o out --angles nan", 2, &["expected a number from 0 to 89.9"]);
    refused("lab spikes -o out --depths 0", 2, &["expected a number from 0.01 to 1000"]);
    refused("lab spikes -o out --minify 3", 2, &["expected a power of two"]);
    refused("lab spikes -o out --techniques displacement:9", 2, &["geometry"]);
    refused("lab spikes -o out --techniques occlusion:9", 2, &["exact:cells", "occlusion:8..32"]);
    refused("lab spikes -o out --rays 0", 2, &["expected a whole number"]);
    refused("lab spikes -o out --quick --full", 2, &["--full"]);
    refused("lab spikes -o out --backend gpu", 1, &["GPU"]);
    refused("lab spikes -o out --backend cpu --adapter x", 2, &["--adapter"]);
}

#[test]
fn tune_finds_what_is_known_and_its_scene_is_drawn() {
    let room = Room::new();
    let needles = room.ok("tune spikes --max-error 1 --depth 25 --size 64 --rays 512 --cost fetches").stdout;
    assert!(
        needles.contains("error at most 1 texels: exact\n") && needles.contains("this is the default"),
        "{needles}"
    );
    assert!(needles.contains("than occlusion:8..32 (the tutorials' rule), which is off by"), "{needles}");

    room.write("flat.png", png(32, 32));
    let flat = room
        .ok("tune flat.png --max-error 1 --angle-max 10 --height-scale 0.001 --rays 64 -o flat.toml --cost fetches");
    assert!(flat.stdout.contains(": normal\n") && flat.stdout.contains("100 % less"), "{}", flat.stdout);
    room.ok("render flat.toml -o flat-drawn.png --size 32x24 --backend cpu");

    let made = "tune make:cobbles --max-error 0.7 --angle-max 50 --size 64 --rays 256 --cost fetches";
    room.ok(&format!("{made} -o cobbles.toml --json tried.json"));
    let text = String::from_utf8(room.read("cobbles.toml")).unwrap();
    assert!(
        text.starts_with("# Made by `relievo tune`.\n# cobbles,") && text.contains("from = \"make:cobbles\""),
        "{text}"
    );
    room.ok("render cobbles.toml -o cobbles.png --size 32x24 --make-size 32 --backend cpu");
    let json = room.json("tried.json");
    let best = &json["trials"][json["best"].as_u64().unwrap() as usize];
    assert!(best["error"].as_f64().unwrap() <= 0.7 && best["keeps"] == true, "{best}");
    let technique = best["candidate"].as_str().unwrap().split(':').next().unwrap();
    assert!(text.contains(&format!("technique = \"{technique}\"")), "{text}");
}

#[test]
fn tune_writes_into_a_scene_and_leaves_the_rest_as_it_is() {
    let room = Room::new();
    let before = String::from_utf8(room.read("scene.toml")).unwrap();
    room.ok("tune make:brick-wall --max-error 1 --angle-max 20 --size 64 --rays 256 --cost fetches --write scene.toml");
    let after = String::from_utf8(room.read("scene.toml")).unwrap();
    assert!(after.contains("shadow = \"exact\"\ntechnique = \""), "{after}");
    let kept: String = after
        .lines()
        .filter(|line| !["technique", "min_", "max_", "refine"].iter().any(|key| line.starts_with(key)))
        .map(|line| format!("{line}\n"))
        .collect();
    assert_eq!(kept, before);
    room.ok("render scene.toml -o drawn.png --make-size 16 --backend cpu");
}

#[test]
fn what_cannot_be_tuned_is_refused() {
    refused("tune spikes", 2, &["--max-error"]);
    refused("tune spikes --max-error -1", 2, &["expected a number from 0"]);
    refused("tune spikes --max-error x", 2, &["expected a number from 0"]);
    refused("tune spikes --max-error 0 --size 32 --rays 64", 1, &["no technique keeps an error of 0 texels", "exact"]);
    refused("tune corpus --max-error 1 --size 32", 2, &["several materials"]);
    refused("tune spikes --max-error 1 -o x.toml", 2, &["spikes: this map is the lab's own"]);
    refused("tune spikes --max-error 1 --json no/x.json", 1, &["make it first"]);
    refused("tune spikes --max-error 1 --unit miles", 2, &["texels"]);
    refused("tune spikes --max-error 1 --depth 3 --height-scale 3", 2, &["--height-scale"]);
    refused("tune spikes --max-error 1 -o x.png", 2, &["x.png: a scene is a file whose name ends in .toml"]);
    refused("tune spikes --max-error 1 --write no.toml", 1, &["no.toml"]);
    refused("tune spikes --max-error 1 --write scene.toml --into floor", 1, &["[materials.floor]", "wall"]);
    refused("tune spikes --max-error 1 --into wall", 2, &["--write"]);
    refused("tune spikes --max-error 1 --unit flip --angle-max 88", 1, &["must be 0 to 85"]);
    refused("tune spikes --max-error 1 --backend gpu", 1, &["GPU"]);
}
