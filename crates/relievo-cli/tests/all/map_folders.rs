//! `relievo map` on folders: of materials, of loose pictures, of recipes; done once, and only what changed again.

use crate::files;
use crate::map::{refused, size};
use crate::room::Room;

/// Runs a verb twice; the second time everything was done before, and a file that is gone is made again, the same.
#[track_caller]
fn twice(room: &Room, arguments: &str, count: usize, file: &str) {
    room.ok(arguments);
    let first = room.read(file);
    let again = room.ok(arguments).stderr;
    assert!(again.contains(&format!("{count} materials were done before")), "{arguments}: {again}");
    std::fs::remove_file(room.path(file)).unwrap();
    room.ok(arguments);
    assert_eq!(room.read(file), first, "{arguments}");
}

fn photos(room: &Room) {
    room.write("photos/DSC_0001.png", files::png(24, 16));
    room.write("photos/DSC_0002.png", files::png(9, 13));
    room.write("photos/readme.txt", "no picture");
}

#[test]
fn loose_photos_become_a_material_each() {
    let room = Room::new();
    photos(&room);
    twice(&room, "map from-photo photos -o made --preset brick", 2, "made/DSC_0001/DSC_0001_NormalGL.png");
    assert_eq!(size(&room, "made/DSC_0002/DSC_0002_Displacement.png"), (9, 13));
    // A new photo is the only work; a broken one does not stop the others, and the run fails in the end.
    room.write("photos/DSC_0000.png", "broken");
    room.write("photos/DSC_0003.png", files::png(8, 8));
    let outcome = room.run("map from-photo photos -o made --preset brick".split(' '));
    assert_eq!(outcome.code, Some(1));
    assert!(outcome.stderr.contains("DSC_0000.png: not an image"), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("2 materials were done before"), "{}", outcome.stderr);
    assert_eq!(size(&room, "made/DSC_0003/DSC_0003_Color.png"), (8, 8));
}

#[test]
fn every_verb_takes_a_folder_of_loose_maps() {
    let room = Room::new();
    photos(&room);
    room.write("line.svg", r#"<svg viewBox="0 0 9 9"><path d="M1 1 8 8" stroke="black"/></svg>"#);
    for (verb, suffix) in [
        ("normal", "NormalGL"),
        ("ao", "AmbientOcclusion"),
        ("bent", "BentNormal"),
        ("curvature", "Curvature"),
        ("edit", "Displacement"),
    ] {
        let steps = if verb == "edit" { "blur=0.01" } else { "" };
        let file = format!("{verb}/DSC_0001_{suffix}.png");
        twice(&room, &format!("map {verb} photos {steps} -o {verb}"), 2, &file);
    }
    twice(&room, "map edit photos invert --kind scalar -o edited", 2, "edited/DSC_0002_Edited.png");
    twice(&room, "map paint line.svg --on photos -o painted", 2, "painted/DSC_0001_Displacement.png");
    // Normals are loose maps in a folder of their own.
    for k in [1, 2] {
        let normals = room.read(&format!("normal/DSC_000{k}_NormalGL.png"));
        room.write(&format!("loose/{k}.png"), normals);
    }
    twice(&room, "map height loose -o heights", 2, "heights/1_Displacement.png");
}

#[test]
fn two_loose_files_of_one_name_both_get_their_maps() {
    let room = Room::new();
    room.write("p/a.png", files::png(8, 8));
    room.write("p/a.exr", files::exr(0.5));
    room.ok("map normal p -o n");
    assert_eq!((size(&room, "n/a_NormalGL.png"), size(&room, "n/a_png_NormalGL.png")), ((4, 4), (8, 8)));
}

#[test]
fn maps_are_not_written_over_what_they_are_made_of() {
    let room = Room::new();
    photos(&room);
    room.ok("map make tiles -o tiles --size 16");
    refused(&room, "map normal photos -o photos", 1, &["photos: loose files", "choose another folder"]);
    let before = room.read("tiles/tiles_Displacement.png");
    for command in ["map edit tiles invert -o tiles", "map edit tiles rotate=90 --kind normal -o tiles"] {
        let outcome = room.run(command.split(' '));
        assert_eq!(outcome.code, Some(1), "{command}");
        assert!(outcome.stderr.contains("would overwrite the map that is read"), "{}", outcome.stderr);
    }
    assert_eq!(room.read("tiles/tiles_Displacement.png"), before);
}

#[test]
fn a_folder_of_recipes_becomes_materials() {
    let room = Room::new();
    for name in ["tiles", "rivets"] {
        room.write(&format!("recipes/{name}.toml"), room.ok(&format!("map make {name} --text")).stdout);
    }
    twice(&room, "map make recipes -o made --size 16", 2, "made/rivets/rivets_Color.png");
    room.write(
        "recipes/cycle.toml",
        "[steps.a]\nop = \"blur\"\ninput = \"a\"\n[output]\nheight = \"a\"\ncolor = \"a\"\nroughness = \"a\"\n",
    );
    let outcome = room.run("map make recipes -o made --size 16".split(' '));
    assert_eq!(outcome.code, Some(1));
    assert!(outcome.stderr.contains("cycle.toml:3: ") && outcome.stderr.contains("a needs a"), "{}", outcome.stderr);
    // Another seed is other work.
    let first = room.read("made/tiles/tiles_Color.png");
    room.run("map make recipes -o made --size 16 --seed 4".split(' '));
    assert_ne!(room.read("made/tiles/tiles_Color.png"), first);
    room.write("empty/readme.txt", "nothing");
    refused(&room, "map make empty -o x", 1, &["empty: there are no recipes", ".toml"]);
}

#[test]
fn a_materials_roughness_is_edited_by_its_kind() {
    let room = Room::new();
    room.ok("map make tiles -o tiles --size 16");
    room.ok("map edit tiles invert --kind scalar -o edited");
    let at = |name: &str| image::open(room.path(name)).unwrap().into_luma16().get_pixel(3, 3).0[0];
    let (before, after) = (at("tiles/tiles_Roughness.png"), at("edited/tiles_Roughness.png"));
    assert!(before.abs_diff(65535 - after) <= 1, "{before} {after}");
}

/// A quick sweep of one material.
const LAB: &str = "lab spikes -o out --quick --size 32 --rays 32 --angles 60 --depths 5 --techniques exact \
                   --picture-size 16x12 --backend cpu";

#[test]
fn maps_and_reports_live_in_one_folder() {
    let room = Room::new();
    photos(&room);
    for order in [["map ao photos -o out", LAB], [LAB, "map ao photos -o out"]] {
        room.remove("out");
        for command in order {
            assert!(!room.ok(command).stderr.contains("done before"), "{order:?}");
        }
        let again = order.map(|command| room.ok(command).stderr);
        for (stderr, command) in again.iter().zip(order) {
            let all = if command == LAB { "2 cases were done before" } else { "2 materials were done before" };
            assert!(stderr.contains(all), "{order:?}: {stderr}");
        }
    }
}

#[test]
fn two_verbs_remember_both_what_they_did_in_one_folder() {
    let room = Room::new();
    photos(&room);
    let skips = |command: &str| room.ok(command).stderr.contains("2 materials were done before");
    assert!(!skips("map ao photos -o out") && !skips("map normal photos -o out"));
    assert!(skips("map ao photos -o out") && skips("map normal photos -o out"));
    // Every option counts; a file that another verb wrote over is made again.
    assert!(!skips("map ao photos -o out --directions 8") && !skips("map ao photos -o out --format png8"));
    let (edit, paint) = ("map edit photos invert -o out", "map paint line.svg --on photos -o out");
    room.write("line.svg", r#"<svg viewBox="0 0 9 9"><path d="M1 1 8 8" stroke="black"/></svg>"#);
    assert!(!skips(edit) && skips(edit) && !skips(paint) && !skips(edit) && skips(edit));
    // Another drawing under the same name is another.
    assert!(!skips(paint) && skips(paint));
    room.write("line.svg", r#"<svg viewBox="0 0 9 9"><path d="M1 1 8 7" stroke="black"/></svg>"#);
    assert!(!skips(paint));
}

#[test]
fn manifests_of_other_versions_are_told_from_broken_ones() {
    let room = Room::new();
    photos(&room);
    let old = [
        r#"{"DSC_0001": {"command": "ao x", "input": "photos/DSC_0001.png", "bytes": 1, "changed": 2, "outputs": []}}"#,
        r#"{"spikes-cpu-5-1": "relievo 0.1.0, maps 0123456789abcdef, on CPU"}"#,
    ];
    for text in old {
        for (command, skipped) in [("map ao photos -o out", "2 materials were done"), (LAB, "2 cases were done")] {
            room.remove("out");
            room.write("out/relievo-manifest.json", text);
            let stderr = room.ok(command).stderr;
            assert!(stderr.contains("note: ") && stderr.contains("an earlier version of Relievo"), "{stderr}");
            let again = room.ok(command).stderr;
            assert!(again.contains(skipped) && !again.contains("an earlier version"), "{again}");
        }
    }
    for command in ["map ao photos -o out", LAB] {
        room.write("out/relievo-manifest.json", r#"{"version": 99}"#);
        refused(&room, command, 1, &["relievo-manifest.json", "a later version of Relievo", "another folder"]);
        room.write("out/relievo-manifest.json", "hello");
        refused(&room, command, 1, &["relievo-manifest.json: this is no manifest of Relievo", "move it away"]);
    }
}
