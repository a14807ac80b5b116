//! `relievo compare`: the sheet, the figures, the heat maps.

use serde_json::Value;

use crate::room::Room;

const FOUR: &str = "none,occlusion,exact,displacement:10";

#[test]
fn figures_rank_the_techniques_as_they_are() {
    let room = Room::new();
    room.ok(&format!("compare scene.toml --make-size 64 --techniques {FOUR} --json s.json"));
    assert_eq!(room.names(), ["out.png", "s.json", "scene.toml"]);
    let json = room.json("s.json");
    assert_eq!((&json["width"], &json["height"]), (&Value::from(64), &Value::from(48)));
    let truth = &json["truth"];
    // Two vertices per texel of 64: 128 cells a side.
    assert_eq!((&truth["grids"][0], &truth["triangles"]), (&Value::from(129), &Value::from(2 * 128 * 128)));

    let techniques = json["techniques"].as_array().unwrap();
    let names: Vec<&str> = techniques.iter().map(|entry| entry["technique"].as_str().unwrap()).collect();
    assert_eq!(names.join(","), FOUR);
    for entry in techniques {
        for key in ["flip", "psnr_db", "frame_ms", "build_ms"] {
            let value = entry[key].as_f64().unwrap();
            assert!(value >= 0.0 && value.is_finite(), "{key} {entry}");
        }
        for (key, part) in [("fetches", entry), ("iterations", entry), ("texels", &entry["hit_error"])] {
            for figure in ["mean", "p50", "p95", "p99", "max"] {
                assert!(part[key][figure].as_f64().unwrap() >= 0.0, "{key}.{figure} {entry}");
            }
        }
    }
    let [none, occlusion, exact, displacement] = techniques.as_slice() else { panic!("{techniques:?}") };
    let flip = |entry: &Value| entry["flip"].as_f64().unwrap();
    assert!(flip(exact) < flip(occlusion) && flip(occlusion) < flip(none), "{json:#}");
    assert!(flip(exact) < 0.02 && flip(none) > 0.1 && flip(displacement) > flip(exact), "{json:#}");
    let psnr = |entry: &Value| entry["psnr_db"].as_f64().unwrap();
    assert!(psnr(exact) > psnr(occlusion) && psnr(occlusion) > psnr(none), "{json:#}");
    let wrong = |entry: &Value| entry["hit_error"]["wrong"].as_f64().unwrap();
    assert_eq!(wrong(exact), 0.0);
    assert!(wrong(occlusion) < 0.1 && wrong(none) > 0.2 && wrong(none) <= 1.0, "{json:#}");
    let fetches = |entry: &Value| entry["fetches"]["mean"].as_f64().unwrap();
    assert!(fetches(none) == 0.0 && fetches(displacement) == 0.0 && fetches(occlusion) >= 1.0 && fetches(exact) >= 1.0);
    assert_eq!((&none["triangles"], &displacement["triangles"]), (&Value::from(2), &Value::from(2 * 9 * 9)));
}

#[test]
fn without_a_list_every_technique_is_compared() {
    let room = Room::new();
    room.ok("compare scene.toml --make-size 32 --size 32x24 --samples 1 --json s.json -o sheet.png");
    let json = room.json("s.json");
    let names: Vec<&str> =
        json["techniques"].as_array().unwrap().iter().map(|entry| entry["technique"].as_str().unwrap()).collect();
    assert_eq!(
        names.join(" "),
        "none normal basic offset-limiting unity-offset steep binary relief occlusion contact cone exact \
         displacement:10 displacement:100"
    );
}

#[test]
fn heat_maps_make_the_sheet_taller_by_a_picture_each() {
    let room = Room::new();
    let sheet = |heat: &str| {
        room.ok(&format!("compare scene.toml --make-size 64 --techniques none,exact -o sheet.png {heat}"));
        room.picture("sheet.png")
    };
    let plain = sheet("");
    // Three pictures side by side, their text below.
    assert!(plain.width() > 3 * 64 && plain.height() > 48 + 6 * 10, "{:?}", plain.dimensions());
    let one = ["--heat flip", "--heat hits", "--heat fetches"].map(sheet);
    let rows = one[0].height();
    assert!(rows >= plain.height() + 48 && one[2].height() == rows, "{rows}");
    assert!(one[0] != one[1] && one[1] != one[2]);
    // A line on what green means comes with the hits.
    assert!(one[1].height() > rows);
    let three = sheet("--heat flip,hits,fetches");
    assert_eq!(three.height(), one[1].height() + 2 * 48);
    assert_eq!(three.width(), plain.width());
}

#[test]
fn a_sheet_shows_the_pictures_pixel_by_pixel() {
    let room = Room::new();
    room.ok("render scene.toml -o one.png --make-size 64 --samples 4 --technique occlusion --set materials.wall.relief.write_depth=true");
    room.ok("compare scene.toml --make-size 64 --techniques occlusion -o sheet.png");
    let (picture, sheet) = (room.picture("one.png"), room.picture("sheet.png"));
    let found = (0..=sheet.width() - 64).any(|x| {
        (0..=sheet.height() - 48)
            .any(|y| picture.enumerate_pixels().all(|(i, j, pixel)| sheet.get_pixel(x + i, y + j) == pixel))
    });
    assert!(found);
}

#[test]
fn figures_to_stdout_are_json_and_nothing_else() {
    let room = Room::new();
    let outcome = room.ok("compare scene.toml --make-size 16 --techniques none --json -");
    let json: Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert_eq!(json["techniques"][0]["technique"], "none");
    assert_eq!(room.names(), ["out.png", "scene.toml"]);
}

#[test]
fn pictures_that_are_equal_have_no_psnr() {
    let room = Room::new();
    let outcome = room.ok("compare scene.toml --make-size 16 --techniques displacement:40 --truth-grid 40 --json -");
    let json: Value = serde_json::from_str(&outcome.stdout).unwrap();
    let entry = &json["techniques"][0];
    assert_eq!((&entry["psnr_db"], &entry["flip"]), (&Value::Null, &Value::from(0.0)));
}

#[test]
fn large_scenes_shrink_to_a_tile_and_sizes_asked_for_stay() {
    let room = Room::new();
    let size = |options: &str| {
        let run = format!("compare scene.toml --make-size 16 --techniques none --samples 1 --json - {options}");
        let json: Value = serde_json::from_str(&room.ok(&run).stdout).unwrap();
        [json["width"].as_u64().unwrap(), json["height"].as_u64().unwrap()]
    };
    assert_eq!(size("--set image.width=1600 --set image.height=600"), [400, 150]);
    assert_eq!(size("--set image.width=16000 --set image.height=1"), [400, 1]);
    assert_eq!(size("--size 500x20"), [500, 20]);
}

#[test]
fn runs_and_threads_do_not_change_the_figures() {
    let room = Room::new();
    let run = |threads: &str| {
        let outcome = room.ok(&format!(
            "compare scene.toml --make-size 32 --size 32x24 --techniques steep,displacement:20 --json - --threads {threads}"
        ));
        let mut json: Value = serde_json::from_str(&outcome.stdout).unwrap();
        for entry in json["techniques"].as_array_mut().unwrap() {
            entry["frame_ms"] = Value::Null;
            entry["build_ms"] = Value::Null;
        }
        json["techniques"].take()
    };
    let first = run("1");
    assert_eq!(first, run("1"));
    assert_eq!(first, run("3"));
}

#[test]
fn a_truth_that_is_too_coarse_says_so_and_hits_are_judged_all_the_same() {
    let room = Room::new();
    let run = |options: &str| {
        let outcome = room.ok(&format!("compare scene.toml --make-size 64 --techniques exact --json - {options}"));
        (serde_json::from_str::<Value>(&outcome.stdout).unwrap(), outcome.stderr)
    };
    let (fine, said) = run("");
    assert_eq!(
        (&fine["truth"]["per_texel"][0], &fine["truth"]["notes"]),
        (&Value::from(2.0), &Value::Array(Vec::new()))
    );
    assert!(!said.contains("vertices per texel"), "{said}");
    let (coarse, said) = run("--truth-grid 17");
    assert_eq!(
        (&coarse["truth"]["grids"][0], &coarse["truth"]["per_texel"][0]),
        (&Value::from(17), &Value::from(0.25))
    );
    assert!(said.contains("note: ") && said.contains("0.25 vertices per texel"), "{said}");
    assert_eq!(coarse["truth"]["notes"].as_array().unwrap().len(), 1);
    let flip = |json: &Value| json["techniques"][0]["flip"].as_f64().unwrap();
    assert!(flip(&coarse) > 2.0 * flip(&fine), "{} {}", flip(&coarse), flip(&fine));
    assert_eq!(coarse["techniques"][0]["hit_error"], fine["techniques"][0]["hit_error"]);
}

#[test]
fn many_repeats_and_many_triangles_are_judged_as_finely_as_few() {
    let room = Room::new();
    let run = |options: &str| {
        let options = format!("compare scene.toml --make-size 64 --size 32x24 --techniques exact --json - {options}");
        serde_json::from_str::<Value>(&room.ok(&options).stdout).unwrap()
    };
    for options in ["--set objects.0.uv_repeat=100 --set objects.0.scale=100", "--set objects.0.mesh=cube"] {
        let json = run(options);
        assert!(json["truth"]["per_texel"][0].as_f64().unwrap() >= 2.0, "{json:#}");
        assert!(json["truth"]["triangles"].as_u64().unwrap() > 100_000, "{json:#}");
    }
}
