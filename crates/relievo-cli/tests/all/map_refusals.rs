//! `relievo map` given what makes no sense: numbers that are none, absurd sizes, what cannot be written. Nothing is lost.

use std::fs;

use crate::files;
use crate::map::refused;
use crate::room::Room;

/// One map or picture for each verb, and where its result goes.
const VERBS: [&str; 9] = [
    "map normal MAP -o x.png",
    "map height MAP -o x.png",
    "map ao MAP -o x.png",
    "map bent MAP -o x.png",
    "map curvature MAP -o x.png",
    "map edit MAP blur=0.1 -o x.png",
    "map edit MAP blur=0.1 --kind color -o x.png",
    "map paint line.svg --on MAP -o x.png",
    "map from-photo MAP -o x",
];

fn room() -> Room {
    let room = Room::new();
    room.write("line.svg", r#"<svg viewBox="0 0 9 9"><path d="M1 1 8 8" stroke="black"/></svg>"#);
    room.write("good.png", files::png(8, 8));
    room
}

#[test]
fn pixels_that_are_no_numbers_are_refused_by_every_verb() {
    let room = room();
    for (name, value) in [("nan.exr", f32::NAN), ("infinite.exr", f32::INFINITY)] {
        room.write(name, files::exr(value));
        // A colour may be a highlight gone mad: it is tamed, and that is said.
        let of_color = |verb: &str| verb.contains("color") || verb.contains("from-photo");
        for verb in VERBS {
            let command = verb.replace("MAP", name);
            if of_color(verb) {
                let said = room.ok(&command).stderr;
                assert!(said.contains(&format!("{name}: 16 texels with NaN or infinity")), "{verb}: {said}");
                room.remove("x");
                room.remove("x.png");
            } else {
                refused(&room, &command, 1, &[name, "not finite numbers", "column 0, row 0"]);
            }
        }
        refused(&room, &format!("map edit good.png max={name} -o x.png"), 1, &[name, "not finite"]);
        refused(&room, &format!("map edit good.png mask=good.png,{name} -o x.png"), 1, &[name, "not finite"]);
        refused(&room, &format!("map from-photo good.png --mask {name} -o x"), 1, &[name, "not finite"]);
    }
}

#[test]
fn files_that_are_cut_off_or_claim_absurd_sizes_are_refused_by_every_verb() {
    let room = room();
    room.write("half.png", files::half(files::png(64, 64)));
    room.write("claims.png", files::png_that_claims(1 << 30, 1 << 30));
    room.write("empty.png", "");
    for name in ["half.png", "claims.png", "empty.png"] {
        for verb in VERBS {
            refused(&room, &verb.replace("MAP", name), 1, &[name]);
        }
    }
}

#[test]
fn sizes_that_no_memory_holds_are_refused_before_any_work() {
    let room = room();
    // 8 GiB and more: refused or, on a machine that has them, not tried here.
    let free = fs::read_to_string("/proc/meminfo").ok();
    let free = free.and_then(|text| {
        let line = text.lines().find(|line| line.starts_with("MemAvailable:"))?.to_owned();
        line.split_whitespace().nth(1)?.parse::<u64>().ok()
    });
    if free.is_some_and(|kib| kib < 9 << 20) {
        let resize = "map edit good.png resize=16384x16384 --kind color -o x.png";
        refused(&room, resize, 1, &["GiB of memory", "choose a smaller one"]);
    }
    refused(&room, "map edit good.png resize=99999x1 -o x.png", 2, &["each from 1 to 16384"]);
    refused(&room, "map paint line.svg --size 99999x99999 -o x.png", 2, &["each from 1 to 16384"]);
    refused(&room, "map make cobbles --size 4294967295 -o x", 2, &["from 1 to 8192"]);
    refused(&room, "map make cobbles --size 99999999999999999999 -o x", 2, &["from 1 to 8192"]);
}

/// A read-only file stays, to the byte, and is named.
#[cfg(unix)]
#[test]
fn what_is_read_only_stays_as_it_is() {
    use std::os::unix::fs::PermissionsExt;
    let room = room();
    let lock = |name: &str, mode| fs::set_permissions(room.path(name), fs::Permissions::from_mode(mode)).unwrap();
    room.ok("map normal good.png -o normals.png");
    room.write("kept.png", "kept");
    lock("kept.png", 0o444);
    room.write("locked/readme.txt", "locked");
    lock("locked", 0o555);
    // One file of a material that is there already.
    room.write("material/good_Roughness.png", "kept");
    lock("material/good_Roughness.png", 0o444);
    room.write("material/cobbles_Roughness.png", "kept");
    lock("material/cobbles_Roughness.png", 0o444);
    for verb in VERBS.iter().filter(|verb| verb.ends_with(".png")) {
        let map = if verb.contains("height") { "normals.png" } else { "good.png" };
        let verb = verb.replace("MAP", map);
        refused(&room, &verb.replace("x.png", "kept.png"), 1, &["kept.png: this file is read-only"]);
        refused(&room, &verb.replace("x.png", "locked/x.png"), 1, &["the folder locked is read-only"]);
    }
    for verb in ["map from-photo good.png", "map make cobbles --size 16"] {
        refused(&room, &format!("{verb} -o locked"), 1, &["locked: this folder is read-only"]);
        refused(&room, &format!("{verb} -o material"), 1, &["_Roughness.png: this file is read-only"]);
    }
    refused(&room, "map ao . -o locked", 1, &["locked: this folder is read-only"]);
    refused(&room, "map make --list -o kept.png", 1, &["kept.png: this file is read-only"]);
    refused(&room, "map make tiles --text -o kept.png", 1, &["kept.png: this file is read-only"]);
    assert_eq!((room.read("kept.png"), room.read("material/good_Roughness.png")), (b"kept".to_vec(), b"kept".to_vec()));
    lock("locked", 0o755);
}

#[test]
fn garbage_in_the_place_of_recipes_and_drawings_is_refused() {
    let room = room();
    let deep = format!("<svg viewBox='0 0 9 9'>{}</svg>", "<g>".repeat(5000));
    let bomb =
        "<!DOCTYPE svg [<!ENTITY a 'aaaaaaaa'><!ENTITY b '&a;&a;&a;&a;'>]><svg viewBox='0 0 9 9'><path d='&b;'/></svg>";
    for (name, text) in [
        ("deep.svg", deep.as_str()),
        ("bomb.svg", bomb),
        ("nul.svg", "\0\0\0\0"),
        ("huge.svg", "<svg viewBox='0 0 1e-300 1e300'><path stroke='red' d='M0 0 L 1 1'/></svg>"),
        ("far.svg", "<svg viewBox='0 0 9 9'><path stroke='red' d='M0 0 L 1e30 1'/></svg>"),
        ("wide.svg", "<svg viewBox='0 0 9 9'><path stroke='red' stroke-width='1e9' d='M0 0 L 1 1'/></svg>"),
        ("none.svg", "<svg viewBox='0 0 9 9'><path d='M0 0 L 1 1'/></svg>"),
        ("nul.toml", "\0"),
        ("far.toml", "[[strokes]]\npoints = [[0, 1e30]]\n"),
        ("none.toml", "strokes = []\n"),
    ] {
        room.write(name, text);
        refused(&room, &format!("map paint {name} -o x.png"), 1, &[name]);
    }
    room.write("bytes.svg", [0xff, 0xfe, 0x00]);
    refused(&room, "map paint bytes.svg -o x.png", 1, &["bytes.svg", "UTF-8"]);
    for (name, text) in [
        ("nul.toml", "\0".to_owned()),
        ("nest.toml", "a = ".to_owned() + &"[".repeat(10_000)),
        ("brackets.toml", format!("[steps.a]\nop = \"formula\"\nformula = \"{}1\"\n", "(".repeat(20_000))),
        ("minus.toml", format!("[steps.a]\nop = \"formula\"\nformula = \"{}1\"\n", "-".repeat(20_000))),
    ] {
        room.write(name, text);
        refused(&room, &format!("map make {name} -o x"), 1, &[name]);
    }
}
