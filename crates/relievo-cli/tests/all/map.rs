//! `relievo map`: what its verbs write, and what is said when they cannot.

use image::{DynamicImage, GenericImageView};

use crate::room::{KNOWN, Room};

pub(crate) fn size(room: &Room, name: &str) -> (u32, u32) {
    image::open(room.path(name)).unwrap_or_else(|error| panic!("{name}: {error}")).dimensions()
}

/// A file that is no picture of 8 bits.
fn has_16_bits(room: &Room, name: &str) -> bool {
    matches!(
        image::open(room.path(name)).unwrap(),
        DynamicImage::ImageLuma16(_) | DynamicImage::ImageRgb16(_) | DynamicImage::ImageRgb32F(_)
    )
}

/// Fails with this exit code and these words, and leaves all files as they were.
#[track_caller]
pub(crate) fn refused(room: &Room, arguments: &str, code: i32, says: &[&str]) {
    let before: Vec<_> = room.names();
    let outcome = room.run(arguments.split_whitespace());
    assert_eq!(outcome.code, Some(code), "{arguments}: {}", outcome.stderr);
    for words in says {
        assert!(outcome.stderr.contains(words), "{arguments}\n  should say {words}\n  {}", outcome.stderr);
    }
    assert!(!outcome.stderr.contains("panicked") && !outcome.stderr.contains("os error"), "{}", outcome.stderr);
    assert_eq!(room.names(), before, "{arguments}");
    assert_eq!(room.read("out.png"), KNOWN);
}

const RECIPE: &str = r#"
[steps.bumps]
op = "noise"
cells = 4
octaves = 4
[steps.height]
op = "formula"
formula = "0.5 + 0.25 * bumps"
[output]
height = "height"
color = "height"
roughness = "height"
"#;

#[test]
fn a_recipe_becomes_a_folder_that_a_scene_can_use() {
    let room = Room::new();
    room.ok("map make cobbles -o stones --size 64");
    let maps = ["AmbientOcclusion", "Color", "Displacement", "NormalGL", "Roughness"];
    let files: Vec<String> = maps.iter().map(|map| format!("stones/cobbles_{map}.png")).collect();
    for file in &files {
        assert_eq!(size(&room, file), (64, 64));
        assert_eq!(has_16_bits(&room, file), !file.contains("Color"), "{file}");
    }
    let scene = String::from_utf8(room.read("scene.toml")).unwrap();
    room.write("stones.toml", scene.replace("make:brick-wall", "stones"));
    room.ok("render stones.toml -o picture.png --size 32x24");
}

#[test]
fn a_recipe_of_ones_own_is_followed_and_the_same_every_time() {
    let room = Room::new();
    room.write("mine.toml", RECIPE);
    room.ok("map make mine.toml -o a --size 48");
    room.ok("map make mine.toml -o b --size 48");
    room.ok("map make mine.toml -o c --size 48 --seed 9");
    assert_eq!(room.read("a/mine_Displacement.png"), room.read("b/mine_Displacement.png"));
    assert_ne!(room.read("a/mine_Displacement.png"), room.read("c/mine_Displacement.png"));
}

#[test]
fn recipes_are_listed_and_their_texts_can_be_had() {
    let room = Room::new();
    let list = room.ok("map make --list").stdout;
    for name in ["brick-wall", "bricks-flemish", "cobbles", "cracked-earth", "terrain"] {
        assert!(list.lines().any(|line| line.starts_with(name)), "{name}");
    }
    let text = room.ok("map make tiles --text").stdout;
    room.write("tiles.toml", text);
    room.ok("map make tiles.toml -o mine --size 16");
    room.ok("map make tiles -o theirs --size 16");
    assert_eq!(room.read("mine/tiles_Displacement.png"), room.read("theirs/tiles_Displacement.png"));
}

#[test]
fn wrong_recipes_are_refused_and_nothing_is_written() {
    let room = Room::new();
    room.write("cycle.toml", RECIPE.replace("* bumps", "* height"));
    room.write("name.toml", RECIPE.replace("* bumps", "* bump"));
    room.write("bytes.toml", b"\xff\xfe");
    room.write("file", "");
    refused(&room, "map make cycle.toml -o x", 1, &["cycle.toml:8: ", "circle: height needs height"]);
    refused(&room, "map make name.toml -o x", 1, &["name.toml:8: ", "no step \"bump\"", "did you mean \"bumps\"?"]);
    refused(&room, "map make bytes.toml -o x", 1, &["bytes.toml", "UTF-8"]);
    refused(&room, "map make no.toml -o x", 1, &["no.toml: there is no such recipe"]);
    refused(&room, "map make coble -o x", 1, &["\"coble\"", "did you mean \"cobbles\"?"]);
    refused(&room, "map make cobbles", 2, &["-o FOLDER"]);
    refused(&room, "map make cobbles -o x --size 0", 2, &["from 1 to 8192"]);
    refused(&room, "map make cobbles -o x --size 99999", 2, &["from 1 to 8192"]);
    refused(&room, "map make brick-wall -o x --seed 1", 2, &["no seed"]);
    refused(&room, "map make cobbles -o no/such", 1, &["no folder no", "make it first"]);
    refused(&room, "map make cobbles -o file", 1, &["file: this is a file", "folder is needed"]);
    refused(&room, "map make --list -o sheet.jpg", 2, &["sheet.jpg", ".png"]);
    refused(&room, "map make", 2, &["RECIPE"]);
    refused(&room, "map", 2, &["Usage"]);
}

#[test]
fn normals_and_heights_go_both_ways() {
    let room = Room::new();
    room.ok("map make cobbles -o m --size 64");
    room.ok("map normal m/cobbles_Displacement.png -o n.png --height-scale 0.06");
    let outcome = room.ok("map height n.png -o h.png");
    assert!(outcome.stderr.contains("its height scale is 0.0"), "{}", outcome.stderr);
    let heights = |name: &str| image::open(room.path(name)).unwrap().into_luma16();
    let (before, after) = (heights("m/cobbles_Displacement.png"), heights("h.png"));
    // The heights that come back are stretched to the whole range.
    let range = |map: &image::ImageBuffer<image::Luma<u16>, Vec<u16>>| {
        let values = map.pixels().map(|p| f64::from(p.0[0]));
        values.fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(x), h.max(x)))
    };
    let ((low, high), _) = (range(&before), range(&after));
    for (a, b) in before.pixels().zip(after.pixels()) {
        let (a, b) = ((f64::from(a.0[0]) - low) / (high - low), f64::from(b.0[0]) / 65535.0);
        assert!((a - b).abs() < 0.01, "{a} {b}");
    }
}

#[test]
fn a_photo_becomes_a_material() {
    let room = Room::new();
    room.ok("map make bricks-running -o wall --size 96");
    room.ok("map from-photo wall/bricks-running_Color.png -o made --preset brick --edge tiles");
    for map in ["AmbientOcclusion", "Color", "Displacement", "NormalGL", "Roughness"] {
        assert_eq!(size(&room, &format!("made/bricks-running_{map}.png")), (96, 96));
    }
    assert!(has_16_bits(&room, "made/bricks-running_Displacement.png"));
    // Into its own folder: the photo itself stays, to the byte.
    let photo = room.read("wall/bricks-running_Color.png");
    room.ok("map from-photo wall/bricks-running_Color.png -o wall --edge tiles");
    assert_eq!(room.read("wall/bricks-running_Color.png"), photo);
    refused(
        &room,
        "map from-photo wall/bricks-running_Color.png -o wall --edge make-tile",
        1,
        &["would be overwritten"],
    );
    // With the same options, the same; with others, another.
    let height = |folder: &str| room.read(&format!("{folder}/bricks-running_Displacement.png"));
    let photo = "map from-photo wall/bricks-running_Color.png --preset brick --edge tiles";
    room.ok(&format!("{photo} -o again"));
    room.ok(&format!("{photo} -o picked --pick #a59b8a:-0.6:20"));
    room.ok(&format!("{photo} -o lit --side-light 135 --shading -0.5 --light -1,0,0,1,1,1,0"));
    assert_eq!(height("made"), height("again"));
    assert!(height("made") != height("picked") && height("made") != height("lit"));
    // A folder of materials, restartable.
    room.write("all/readme.txt", "not a material");
    room.ok("map make tiles -o all/tiles --size 32");
    room.ok("map from-photo all -o materials --edge make-tile");
    assert!(room.ok("map from-photo all -o materials --edge make-tile").stderr.contains("done before"));
    assert_eq!(size(&room, "materials/tiles/tiles_NormalGL.png"), (32, 32));
}

#[test]
fn photos_masks_and_picks_that_are_wrong_are_refused() {
    let room = Room::new();
    room.write("p.png", crate::files::png(16, 16));
    room.write("small.png", crate::files::png(4, 4));
    let black = image::GrayImage::new(16, 16);
    black.save(room.path("black.png")).unwrap();
    for (options, code, says) in [
        ("--mask small.png", 1, "the mask has 4×4 texels and the photograph 16×16"),
        ("--mask black.png", 1, "black everywhere"),
        ("--mask no.png", 1, "no.png"),
        ("--pick red:1", 2, "#RRGGBB:OFFSET"),
        ("--pick #ff0000", 2, "#RRGGBB:OFFSET"),
        ("--pick #ff0000:9", 2, "#RRGGBB:OFFSET"),
        ("--light 1,2,3", 2, "7 numbers"),
        ("--light 1,2,3,4,5,6,nan", 2, "7 numbers"),
        ("--levels 90,10", 2, "two shares in percent"),
        ("--shading 1", 2, "--side-light"),
        ("--preset brik", 2, "brick"),
    ] {
        refused(&room, &format!("map from-photo p.png -o x {options}"), code, &[says]);
    }
    refused(&room, "map from-photo no.png -o x", 1, &["no.png"]);
    refused(&room, "map from-photo p.png -o p.png", 1, &["p.png: this is a file", "folder is needed"]);
}

#[test]
fn every_conversion_writes_what_it_says() {
    let room = Room::new();
    room.ok("map make tiles -o m --size 32");
    for (verb, grey) in [("normal", false), ("ao", true), ("bent", false), ("curvature", true)] {
        room.ok(&format!("map {verb} m/tiles_Displacement.png -o {verb}.png"));
        assert!(has_16_bits(&room, &format!("{verb}.png")), "{verb}");
        let picture = image::open(room.path(&format!("{verb}.png"))).unwrap();
        assert_eq!(picture.color().channel_count() == 1, grey, "{verb}");
        room.ok(&format!("map {verb} m/tiles_Displacement.png -o {verb}.exr --border open"));
        room.ok(&format!("map {verb} m/tiles_Displacement.png -o {verb}8.png --format png8"));
        assert!(!has_16_bits(&room, &format!("{verb}8.png")));
    }
    let up = image::open(room.path("normal.png")).unwrap().into_rgb16();
    room.ok("map normal m/tiles_Displacement.png -o down.png --normal-y down");
    let down = image::open(room.path("down.png")).unwrap().into_rgb16();
    assert!(up.pixels().zip(down.pixels()).all(|(a, b)| a.0[0] == b.0[0] && a.0[1].abs_diff(65535 - b.0[1]) <= 1));
}

#[test]
fn a_folder_of_materials_is_done_once_and_only_what_changed_again() {
    let room = Room::new();
    room.write("all/readme.txt", "not a material");
    room.ok("map make tiles -o all/tiles --size 16");
    room.ok("map make planks -o all/planks --size 16");
    room.ok("map ao all -o made");
    let first = room.read("made/tiles_AmbientOcclusion.png");
    let again = room.ok("map ao all -o made");
    assert!(again.stderr.contains("2 materials were done before"), "{}", again.stderr);
    // One file is gone: only it is made again.
    std::fs::remove_file(room.path("made/tiles_AmbientOcclusion.png")).unwrap();
    assert!(room.ok("map ao all -o made").stderr.contains("1 materials were done before"));
    assert_eq!(room.read("made/tiles_AmbientOcclusion.png"), first);
    // Other options are other work.
    assert!(!room.ok("map ao all -o made --radius 0.3").stderr.contains("done before"));
    assert_ne!(room.read("made/tiles_AmbientOcclusion.png"), first);
}

#[test]
fn one_broken_material_does_not_stop_the_others() {
    let room = Room::new();
    room.write("all/broken/broken_Displacement.png", "no picture");
    room.ok("map make tiles -o all/tiles --size 16");
    let outcome = room.run("map normal all -o made".split(' '));
    assert_eq!(outcome.code, Some(1));
    assert!(outcome.stderr.contains("broken_Displacement.png"), "{}", outcome.stderr);
    assert_eq!(size(&room, "made/tiles_NormalGL.png"), (16, 16));
}

#[test]
fn what_cannot_be_read_or_written_is_said() {
    let room = Room::new();
    room.write("text.png", "hello");
    room.write("empty/readme.txt", "nothing");
    room.write("h.png", crate::files::png(8, 8));
    refused(&room, "map normal no.png -o x.png", 1, &["no.png"]);
    refused(&room, "map normal text.png -o x.png", 1, &["text.png: not an image"]);
    refused(&room, "map normal h.png -o x.tif", 1, &["x.tif", ".png or .exr"]);
    refused(&room, "map normal h.png -o no/x.png", 1, &["no folder no", "make it first"]);
    refused(&room, "map normal h.png -o h.png", 1, &["overwrite the map that is read"]);
    refused(&room, "map normal empty -o x", 1, &["empty: neither a material nor a folder of materials"]);
    refused(&room, "map normal h.png -o x.png --height-scale nan", 2, &["from 0 to 100"]);
    refused(&room, "map height h.png -o x.png", 1, &["h.png", "red, green and blue"]);
    refused(&room, "map height h.png", 2, &["--output"]);
}

#[test]
fn edits_are_done_in_their_order_and_keep_the_kind_of_map() {
    let room = Room::new();
    room.ok("map make cobbles -o m --size 48");
    let height = "m/cobbles_Displacement.png";
    room.ok(&format!("map edit {height} invert invert -o same.png"));
    assert_eq!(room.read("same.png"), room.read(height));
    room.ok(&format!("map edit {height} rotate=90 resize=32x64 -o turned.png"));
    assert_eq!(size(&room, "turned.png"), (32, 64));
    room.ok(&format!(
        "map edit {height} blur=0.05 levels=0.2,0.8,1.5 curve=0:0,0.5:0.7,1:1 sharpen=0.01,0.5 median=1 -o a.png"
    ));
    room.ok(&format!(
        "map edit {height} max=a.png min=same.png add=a.png,-0.2 blend=a.png,0.1 mask=a.png,same.png tile -o b.png"
    ));
    assert!(has_16_bits(&room, "a.png") && has_16_bits(&room, "b.png"));
    room.ok(&format!("map edit {height} levels=0,1 -o eight.png --format png8"));
    room.ok("map edit eight.png deband -o sixteen.png");
    room.ok("map edit sixteen.png levels=0,1 -o again.png --format png8");
    assert_eq!(room.read("eight.png"), room.read("again.png"));
    // Turned normals are those of the turned heights.
    room.ok(&format!("map normal {height} -o n.png"));
    room.ok("map edit n.png rotate=90 flip=x --kind normal -o nt.png");
    room.ok(&format!("map edit {height} rotate=90 flip=x -o ht.png"));
    room.ok("map normal ht.png -o nth.png");
    let normals = |name: &str| image::open(room.path(name)).unwrap().into_rgb16();
    assert!(normals("nt.png").as_raw().iter().zip(normals("nth.png").as_raw()).all(|(a, b)| a.abs_diff(*b) <= 2));
    room.ok("map edit m/cobbles_Color.png tile resize=20x20 flip=y --kind color -o c.png");
    assert_eq!(size(&room, "c.png"), (20, 20));
    room.ok("map edit m blur=0.01 -o folder");
    assert!(room.ok("map edit m blur=0.01 -o folder").stderr.contains("done before"));
}

#[test]
fn edits_that_make_no_sense_are_refused() {
    let room = Room::new();
    room.write("h.png", crate::files::png(8, 8));
    room.write("small.png", crate::files::png(4, 4));
    for (steps, code, says) in [
        ("blurr=1", 2, "one of the steps levels, curve"),
        ("blur=2", 2, "a fraction of the width"),
        ("blur=nan", 2, "a fraction of the width"),
        ("levels=1", 2, "levels=LOW,HIGH"),
        ("curve=0:0", 2, "curve=X:Y"),
        ("curve=1:0,0:1", 1, "first numbers rise"),
        ("median=99", 2, "from 0 to 16"),
        ("resize=0x9", 2, "each from 1 to 16384"),
        ("rotate=45", 2, "rotate=90"),
        ("flip=90", 2, "flip=x"),
        ("max=small.png", 1, "8×8 and 4×4"),
        ("max=no.png", 1, "no.png"),
        ("blur=0.1 --kind normal", 2, "normals can be rotated"),
    ] {
        refused(&room, &format!("map edit h.png {steps} -o x.png"), code, &[says]);
    }
    refused(&room, "map edit h.png -o x.png", 2, &["STEP"]);
}

const DRAWING: &str = r#"<svg viewBox="0 0 100 100"><path d="M10 50 H90" stroke="black" stroke-width="8"/></svg>"#;

#[test]
fn strokes_are_painted_on_plains_on_maps_and_on_folders() {
    let room = Room::new();
    room.write("line.svg", DRAWING);
    room.write("line.toml", "width = 0.08\n[[strokes]]\npoints = [[0.1, 0.5], [0.9, 0.5]]\n");
    room.ok("map paint line.svg --size 64x64 -o svg.png --depth -0.5");
    room.ok("map paint line.toml --size 64x64 -o toml.png --depth -0.5");
    assert_eq!(room.read("svg.png"), room.read("toml.png"));
    let heights = image::open(room.path("svg.png")).unwrap().into_luma16();
    let at = |x, y| f64::from(heights.get_pixel(x, y).0[0]) / 65535.0;
    assert!((at(32, 32) - 0.25).abs() < 0.05 && (at(32, 10) - 0.75).abs() < 1e-4);
    room.ok("map paint line.svg --on svg.png -o twice.png --depth 0.5");
    room.write("all/readme.txt", "not a material");
    room.ok("map make tiles -o all/tiles --size 32");
    room.ok("map paint line.svg --on all -o painted --jitter 0.01 --taper --profile sharp");
    assert!(
        room.ok("map paint line.svg --on all -o painted --jitter 0.01 --taper --profile sharp")
            .stderr
            .contains("done before")
    );
    assert_eq!(size(&room, "painted/tiles_Displacement.png"), (32, 32));
}

#[test]
fn strokes_that_cannot_be_read_are_refused() {
    let room = Room::new();
    room.write("garbage.svg", "<svg viewBox='0 0 9 9'><path stroke='red' d='M 0 0 L zebra'/></svg>");
    room.write("text.svg", "hello");
    room.write("bad.toml", "[[strokes]]\npoints = [[0, inf]]\n");
    room.write("line.svg", DRAWING);
    refused(&room, "map paint garbage.svg -o x.png", 1, &["garbage.svg: the path", "zebra"]);
    refused(&room, "map paint text.svg -o x.png", 1, &["text.svg: this is not an SVG drawing"]);
    refused(&room, "map paint bad.toml -o x.png", 1, &["bad.toml:2: points must be pairs"]);
    refused(&room, "map paint no.svg -o x.png", 1, &["no.svg: there is no such file"]);
    refused(&room, "map paint scene.toml -o x.png", 1, &["scene.toml"]);
    refused(&room, "map paint line.svg -o x.png --size 0x4", 2, &["each from 1 to 16384"]);
    refused(&room, "map paint line.svg --on no.png -o x.png", 1, &["no.png"]);
    refused(&room, "map paint line.svg -o no/x.png", 1, &["make it first"]);
}
