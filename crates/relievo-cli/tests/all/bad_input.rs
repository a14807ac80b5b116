//! Whatever is wrong: a sentence that helps, the right exit code, nothing written.

use std::fs;

use crate::files::{exr, glb, half, png, png_that_claims};
use crate::room::{KNOWN, Room, SCENE};

/// One mistake.
struct Case {
    arguments: Vec<String>,
    files: Vec<(&'static str, Vec<u8>)>,
    code: i32,
    /// Words of the error.
    says: Vec<&'static str>,
}

/// A mistake in the arguments, which are separated by spaces.
fn case(arguments: &str, code: i32, says: &[&'static str]) -> Case {
    let arguments = arguments.split(' ').map(str::to_owned).collect();
    Case { arguments, files: Vec::new(), code, says: says.to_vec() }
}

/// A mistake in the scene, here made by `--set`: wrong usage.
fn set(change: &str, says: &[&'static str]) -> Case {
    let mut case = case("render scene.toml -o out.png --set", 2, says);
    case.arguments.push(change.to_owned());
    case
}

/// A mistake in the scene file.
fn scene(text: impl Into<Vec<u8>>, says: &[&'static str]) -> Case {
    let case = case("render scene.toml -o out.png", 1, says);
    case.with("scene.toml", text)
}

/// A scene file with one line exchanged.
fn edited(line: &str, by: &str, says: &[&'static str]) -> Case {
    assert_eq!(SCENE.matches(line).count(), 1, "{line}");
    scene(SCENE.replace(line, by), says)
}

impl Case {
    fn with(mut self, name: &'static str, bytes: impl Into<Vec<u8>>) -> Self {
        self.files.push((name, bytes.into()));
        self
    }

    fn fails_as_it_should(&self) -> Result<(), String> {
        let room = Room::new();
        for (name, bytes) in &self.files {
            room.write(name, bytes);
        }
        let before = room.names();
        let outcome = room.run(&self.arguments);
        let said = &outcome.stderr;
        let ensure = |holds: bool, what: &str| if holds { Ok(()) } else { Err(format!("{what}: {outcome:?}")) };
        ensure(outcome.code == Some(self.code), &format!("exit code should be {}", self.code))?;
        for fragment in &self.says {
            ensure(said.contains(fragment), &format!("should say \"{fragment}\""))?;
        }
        ensure(!said.contains("panicked") && !said.contains("RUST_BACKTRACE"), "panic")?;
        ensure(!said.contains("error: error") && said.matches("error:").count() == 1, "one error, said once")?;
        ensure(!said.contains("os error") && !said.contains("Some(") && !said.contains("..="), "words of programmers")?;
        ensure(!said.contains("note:"), "nothing of the work should be told before it can begin")?;
        ensure(outcome.stdout.is_empty(), "stdout should be empty")?;
        ensure(room.read("out.png") == KNOWN, "out.png has changed")?;
        ensure(room.names() == before, &format!("files are left over: {:?}", room.names()))
    }
}

fn check(cases: &[Case]) {
    let wrong: Vec<String> = cases
        .iter()
        .filter_map(|case| Some(format!("{}\n    {}", case.arguments.join(" "), case.fails_as_it_should().err()?)))
        .collect();
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), cases.len(), wrong.join("\n"));
}

#[test]
fn wrong_arguments_are_wrong_usage() {
    let size = "expected WIDTHxHEIGHT, each from 1 to 16384, as in 800x600";
    check(&[
        case("rendr", 2, &["'rendr'", "'render'"]),
        case("render", 2, &["--output <OUT.png>"]),
        case("render scene.toml", 2, &["--output <OUT.png>"]),
        case("render scene.toml other.toml -o out.png", 2, &["'other.toml'"]),
        case("render scene.toml -o out.png --wat", 2, &["'--wat'"]),
        case("render scene.toml -o out.jpg", 2, &["out.jpg", "end", ".png"]),
        case("render scene.toml -o out", 2, &["'out'", ".png"]),
        case("render scene.toml -o .", 2, &[".png"]),
        case("render scene.toml -o out.png --size huge", 2, &["'huge'", "--size", size]),
        case("render scene.toml -o out.png --size 0x48", 2, &["'0x48'", size]),
        case("render scene.toml -o out.png --size 64x0", 2, &["'64x0'", size]),
        case("render scene.toml -o out.png --size -64x48", 2, &["'-64x48'", size]),
        case("render scene.toml -o out.png --size nanxinf", 2, &["'nanxinf'", size]),
        case("render scene.toml -o out.png --size 64x99999999999", 2, &["'64x99999999999'", size]),
        case("render scene.toml -o out.png --size 16384x16384", 2, &["too many pixels", "134217728"]),
        case("render scene.toml -o out.png --set garbage", 2, &["'garbage'", "PATH=VALUE", "camera.vertical_fov=30"]),
        case("render scene.toml -o out.png --set =5", 2, &["'=5'", "camera.vertical_fov=30"]),
        case("render scene.toml -o out.png --technique cones", 2, &["'cones'", "occlusion", "displacement"]),
        case("render scene.toml -o out.png --technique", 2, &["--technique <TECHNIQUE>"]),
        case("render scene.toml -o out.png --shadow long", 2, &["'long'", "none, hard, soft, exact"]),
        case("render scene.toml -o out.png --backend vulkan", 2, &["'vulkan'", "auto, cpu, gpu"]),
        case("render scene.toml -o out.png --frames 0", 2, &["'0'", "--frames", "a whole number from 1 to"]),
        case("render scene.toml -o out.png --frames -1", 2, &["'-1'", "--frames", "a whole number from 1 to"]),
        case("render scene.toml -o out.png --threads 0", 2, &["'0'", "--threads", "a whole number from 1 to 1024"]),
        case("render scene.toml -o out.png --threads many", 2, &["'many'", "a whole number from 1 to 1024"]),
        case("render scene.toml -o out.png --samples 0", 2, &["'0'", "--samples", "a whole number from 1 to 4096"]),
        case("render scene.toml -o out.png --samples 4097", 2, &["'4097'", "a whole number from 1 to 4096"]),
        case("render scene.toml -o out.png --make-size 0", 2, &["'0'", "--make-size", "from 1 to 8192"]),
        case("render scene.toml -o out.png --make-size 8193", 2, &["'8193'", "from 1 to 8192"]),
        case("render scene.toml -o out.png --max-image-side 0", 2, &["'0'", "--max-image-side", "from 1 to 65536"]),
        case("render scene.toml -o out.png --max-image-bytes 1GB", 2, &["'1GB'", "whole number of bytes"]),
        case("render scene.toml -o out.png --aov depth", 2, &["'depth'", "KIND=FILE", "depth=depth.exr"]),
        case("render scene.toml -o out.png --aov z=z.exr", 2, &["\"z\"", "depth, normal, uv, fetches, shadow, hit"]),
        case("render scene.toml -o out.png --aov depth=z.tif", 2, &["\"z.tif\"", ".exr", ".png"]),
        case("render scene.toml -o out.png --aov depth=out.png", 2, &["out.png", "two outputs"]),
        case("render scene.toml -o out.png --aov uv=a.exr --aov hit=./a.exr", 2, &["./a.exr", "two outputs"]),
        case("render scene.toml -o out.png --stats ./scene.toml", 2, &["./scene.toml", "overwrite the scene file"]),
        case("completions tcsh", 2, &["'tcsh'", "bash"]),
        case("compare scene.toml", 2, &["nothing would be written", "-o SHEET.png", "--json FILE"]),
        case("compare scene.toml -o out.webp", 2, &["out.webp", ".png"]),
        case("compare scene.toml -o out.png --json out.png", 2, &["out.png", "two outputs"]),
        case("compare scene.toml --json scene.toml", 2, &["scene.toml", "overwrite the scene file"]),
        case("compare scene.toml -o out.png --techniques none,relif", 2, &["'relif'", "relief", "displacement:N"]),
        case("compare scene.toml -o out.png --techniques none,,exact", 2, &["''", "expected one of none, normal"]),
        case("compare scene.toml -o out.png --techniques displacement:1", 2, &["'displacement:1'", "2 to 8192"]),
        case("compare scene.toml -o out.png --techniques relief:9", 2, &["'relief:9'", "displacement:N"]),
        case("compare scene.toml -o out.png --heat warm", 2, &["'warm'", "flip, hits, fetches"]),
        case("compare scene.toml -o out.png --truth-grid 1", 2, &["'1'", "--truth-grid", "from 2 to 8192"]),
    ]);
}

#[test]
fn outputs_that_cannot_be_written_are_refused_before_the_work() {
    // A scene that is broken shows that nothing else was looked at before.
    let unread = |arguments: &str, says: &[&'static str]| case(arguments, 1, says).with("scene.toml", "]");
    check(&[
        unread("render scene.toml -o no/out.png", &["no/out.png", "no folder no", "make it first"]),
        unread("render scene.toml -o dir.png", &["dir.png", "is a folder", "name a file"]).with("dir.png/x", ""),
        unread("render scene.toml -o out.png --aov depth=no/z.exr", &["no/z.exr", "make it first"]),
        unread("render scene.toml -o out.png --stats dir", &["dir: this is a folder"]).with("dir/x", ""),
        unread("render scene.toml -o out.png --stats no/s.json", &["no/s.json", "make it first"]),
        unread("compare scene.toml -o no/out.png", &["no/out.png", "make it first"]),
        unread("compare scene.toml -o out.png --json no/s.json", &["no/s.json", "make it first"]),
        unread("render scene.toml -o scene.toml/out.png", &["scene.toml/out.png", "no folder scene.toml"]),
    ]);
}

#[test]
fn broken_scene_files_are_explained_at_the_line() {
    check(&[
        case("render no.toml -o out.png", 1, &["no.toml: ", "there is no such file", "check the spelling"]),
        case("render . -o out.png", 1, &[".: ", "it is a folder"]),
        case("compare no.toml -o out.png", 1, &["no.toml: ", "there is no such file"]),
        case("render out.png -o new.png", 1, &["out.png:1: ", "not valid TOML"]),
        case("render wall.png -o out.png", 1, &["wall.png:1: ", "not text in UTF-8", "is it a scene file?"])
            .with("wall.png", png(4, 4)),
        scene("", &["scene.toml: ", "[[objects]]", "mesh = \"quad\""]),
        scene("objects = []", &["scene.toml:1: ", "[[objects]]"]),
        scene("[[[", &["scene.toml:1: ", "not valid TOML"]),
        scene("[image]\nwidth = \n", &["scene.toml:2: ", "not valid TOML"]),
        scene("[image]\nwidth = 1\nwidth = 2\n", &["scene.toml:3: ", "not valid TOML"]),
        scene("\0\0\0\0", &["scene.toml:1: ", "not valid TOML"]),
        scene(b"[image]\n# \xff\xfe".as_slice(), &["scene.toml:2: ", "not text in UTF-8"]),
        scene("[".repeat(100_000), &["scene.toml:1: ", "not valid TOML"]),
        scene(format!("a = {}", "[".repeat(100_000)), &["scene.toml:1: ", "not valid TOML"]),
        edited("width = 64", "widht = 64", &["scene.toml:3: ", "\"widht\"", "\"width\""]),
        edited("width = 64", "width = 0", &["scene.toml:3: ", "width in [image]", "from 1 to 16384", "0"]),
        edited("width = 64", "width = 99999999999999999999", &["scene.toml:3: ", "too large"]),
        edited("height = 48", "height = 16384\nsamples = 5000", &["scene.toml:5: ", "samples", "1 to 4096", "5000"]),
        edited(
            "width = 64\nheight = 48",
            "width = 16384\nheight = 16384",
            &["scene.toml:3: ", "too many", "134217728"],
        ),
        edited("48.0", "nan", &["scene.toml:7: ", "vertical_fov", "above 0 and below 180", "NaN"]),
        edited("48.0", "inf", &["scene.toml:7: ", "vertical_fov", "found inf"]),
        edited("48.0", "1e400", &["scene.toml:7: ", "vertical_fov", "found"]),
        edited("48.0", "\"wide\"", &["scene.toml:7: ", "vertical_fov", "the text \"wide\""]),
        edited("[-0.9, -0.5, 1.3]", "[nan, 0, 1]", &["scene.toml:6: ", "position", "3 finite numbers", "NaN"]),
        edited("[-0.9, -0.5, 1.3]", "[0, 0, 1e300]", &["scene.toml:6: ", "position", "3 finite numbers", "1e300"]),
        edited("[-0.9, -0.5, 1.3]", "[0, 0]", &["scene.toml:6: ", "position", "3 finite numbers"]),
        edited("[-0.9, -0.5, 1.3]", "[0, 0, 0]", &["scene.toml:6: ", "the same point"]),
        edited("[-0.9, -0.5, 1.3]", "[0, 2, 0]", &["scene.toml:6: ", "line of sight"]),
        edited("[-0.7, -0.5, -0.55]", "[0, 0, 0]", &["scene.toml:10: ", "direction", "no length"]),
        edited("\"directional\"", "\"moon\"", &["scene.toml:9: ", "\"moon\"", "point, directional, spot"]),
        edited("make:brick-wall", "make:brick-well", &["scene.toml:12: ", "\"make:brick-well\"", "brick-wall"]),
        edited("from = ", "form = ", &["scene.toml:12: ", "\"form\"", "\"from\""]),
        edited("shadow = ", "cones = \"round\"\nshadow = ", &["scene.toml:14: ", "\"round\"", "relaxed, conservative"]),
        edited(
            "shadow = ",
            "edge = \"silhouete\"\nshadow = ",
            &["scene.toml:14: ", "\"silhouete\"", "did you mean \"silhouette\"?"],
        ),
        edited("shadow = ", "grid = 9000\nshadow = ", &["scene.toml:14: ", "grid", "2 to 8192", "9000"]),
        edited("\"quad\"", "\"quadd\"", &["scene.toml:16: ", "\"quadd\"", "did you mean \"quad\"?"]),
        edited("material = \"wall\"", "material = \"well\"", &["scene.toml:17: ", "\"well\"", "wall"]),
        edited("material = \"wall\"", "scale = 0", &["scene.toml:17: ", "scale", "0"]),
        edited("material = \"wall\"", "uv_repeat = [1, -1]", &["scene.toml:17: ", "uv_repeat"]),
    ]);
}

#[test]
fn wrong_overrides_are_explained_as_they_were_typed() {
    check(&[
        set("materials.wall.mist.density=1", &["[materials.wall.mist] is for kind = \"mist\""]),
        case(
            "compare scene.toml -o out.png --set materials.wall.kind=mist",
            1,
            &["material \"wall\" is mist", "a comparison judges hits", "relievo render"],
        ),
        set("imgae.width=5", &["--set imgae.width=5: ", "\"imgae\"", "\"image\""]),
        set("camera.fov=30", &["--set camera.fov=30: ", "\"fov\"", "\"vertical_fov\""]),
        set("camera.vertical_fov=wide", &["--set camera.vertical_fov=wide: ", "above 0 and below 180"]),
        set("camera=5", &["--set camera=5: ", "[camera]"]),
        set("lights.7.intensity=1", &["--set lights.7.intensity=1: ", "\"7\" must be an index", "or 1 to add one"]),
        set("camera.near.deep=1", &["--set camera.near.deep=1: "]),
        set("objects=[]", &["--set objects=[]: ", "[[objects]]"]),
        set("camera.near=nan", &["--set camera.near=nan: ", "above 0, found NaN"]),
        set("image.width=1e9", &["--set image.width=1e9: ", "from 1 to 16384"]),
        set("materials.wall.relief.cones=round", &["--set ", "\"round\"", "relaxed, conservative"]),
        set("materials.wall.height=", &["--set materials.wall.height=: ", "the name of an image file"]),
    ]);
}

#[test]
fn broken_images_are_explained_with_file_and_key() {
    let height = |file: &'static str, bytes: Vec<u8>, says: &[&'static str]| {
        let mut case = set(&format!("materials.wall.height={file}"), says).with(file, bytes);
        case.says.extend(["height in [materials.wall]: ", file]);
        case
    };
    let gradient = png(64, 64);
    check(&[
        set("materials.wall.height=no.png", &["height in [materials.wall]: no.png: there is no such file"]),
        set("materials.wall.from=no", &["from in [materials.wall]: no: there is no such file"]),
        set("shading.environment=no.exr", &["environment", "no.exr: there is no such file"]),
        set("materials.wall.height=dir", &["height in [materials.wall]: dir: this is a folder"]).with("dir/x", ""),
        set("materials.wall.from=dir", &["from in [materials.wall]: dir: no maps", "notes.txt"])
            .with("dir/notes.txt", "hello"),
        set("materials.wall.from=scene.toml", &["from in [materials.wall]: scene.toml: this is not a folder"]),
        height("cut.png", half(gradient.clone()), &["damaged or cut short"]),
        height("head.png", gradient[..20].to_vec(), &["damaged or cut short"]),
        height("empty.png", Vec::new(), &["the file is empty"]),
        height("text.png", b"I am not a picture".to_vec(), &["not an image", "its content is text"]),
        height("noise.png", (0..999u32).map(|i| ((i * i) >> 3) as u8).collect(), &["not an image"]),
        height("bomb.png", png_that_claims(60_000, 60_000), &["60000×60000", "16384", "--max-image-side"]),
        height("wide.png", png_that_claims(u32::MAX, 1), &["4294967295×1"]),
        height("flat.png", png_that_claims(0, 4), &["flat.png"]),
        height("big.png", png_that_claims(16_000, 16_000), &["16000×16000", "MiB", "--max-image-bytes"]),
        height("nan.exr", exr(f32::NAN), &["not finite"]),
        height("inf.exr", exr(f32::INFINITY), &["not finite"]),
        height("cut.exr", half(exr(0.5)), &["damaged or cut short"]),
    ]);
}

#[test]
fn broken_meshes_are_explained_with_the_file() {
    let mesh = |file: &'static str, bytes: Vec<u8>, says: &[&'static str]| {
        let mut case = set(&format!("objects.0.mesh={file}"), says).with(file, bytes);
        case.says.extend(["mesh: ", file]);
        case
    };
    let buffer = r#"{"asset":{"version":"2.0"},"buffers":[{"byteLength":12,"uri":"no.bin"}]}"#;
    let huge = r#"{"asset":{"version":"2.0"},"buffers":[{"byteLength":99999999999}],
        "bufferViews":[{"buffer":0,"byteLength":99999999999}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":4000000000,"type":"VEC3"}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}]}"#;
    let circle = r#"{"asset":{"version":"2.0"},"nodes":[{"children":[0]}],"scenes":[{"nodes":[0]}]}"#;
    check(&[
        set("objects.0.mesh=no.glb", &["mesh: no.glb: ", "there is no such file"]),
        set("objects.0.mesh=no.obj", &["mesh: no.obj: ", "there is no such file"]),
        set("objects.0.mesh=dir.glb", &["mesh: dir.glb: this is a folder"]).with("dir.glb/x", ""),
        set("objects.0.mesh=model.fbx", &["\"model.fbx\"", ".glb, .gltf or .obj"]).with("model.fbx", "x"),
        mesh("empty.glb", Vec::new(), &["the file is empty"]),
        mesh("text.glb", b"I am not a model".to_vec(), &["glTF JSON is broken", "export it again"]),
        mesh("cut.glb", half(glb(circle)), &["cut short"]),
        mesh("length.glb", glb(huge), &["bytes"]),
        mesh("circle.glb", glb(circle), &["must form a tree"]),
        mesh("none.glb", glb(r#"{"asset":{"version":"2.0"}}"#), &["no triangles"]),
        mesh("old.gltf", br#"{"asset":{"version":"1.0"}}"#.to_vec(), &["glTF 1.0", "glTF 2.0"]),
        mesh("bad.gltf", b"{\"asset\":".to_vec(), &["glTF JSON is broken"]),
        mesh("deep.gltf", "[".repeat(100_000).into_bytes(), &["glTF JSON is broken"]),
        mesh("alone.gltf", buffer.as_bytes().to_vec(), &["no.bin", "there is no such file"]),
        mesh("empty.obj", Vec::new(), &["no triangles"]),
        mesh("nan.obj", b"v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n".to_vec(), &["line 2", "not finite"]),
        mesh("far.obj", b"v 0 0 0\nf 1 2 3\n".to_vec(), &["line 2", "vertex 2"]),
    ]);
}

#[test]
fn what_is_too_much_is_refused_at_once() {
    check(&[
        case(
            "render scene.toml -o out.png --technique displacement --set materials.wall.relief.grid=8192",
            1,
            &["scene.toml: ", "object 0", "grid = 8192", "smaller grid"],
        ),
        case("compare scene.toml -o out.png --truth-grid 8192", 1, &["scene.toml: ", "smaller grid"]),
        case("compare scene.toml -o out.png --size 16000x4000 --samples 1", 1, &["sheet", "smaller pictures"]),
    ]);
}

#[test]
fn a_comparison_needs_a_relief() {
    let plain = SCENE.replace("from = \"make:brick-wall\"", "base_color = [1, 0, 0]");
    check(&[
        case("compare scene.toml -o out.png", 1, &["scene.toml: ", "no relief", "height"]).with("scene.toml", plain)
    ]);
}

#[test]
fn without_a_gpu_it_is_said_what_to_do() {
    let says: &[&str] = if cfg!(feature = "gpu") {
        &["no GPU adapter", "mesa-vulkan-drivers", "--backend cpu"]
    } else {
        &["this build has no GPU backend", "feature \"gpu\"", "--backend cpu"]
    };
    check(&[
        case("render scene.toml -o out.png --backend gpu", 1, says),
        case("render scene.toml -o out.png --adapter geforce", 1, says),
        case("render scene.toml -o out.png --backend cpu --adapter geforce", 2, &["--adapter", "--backend cpu"]),
    ]);
}

#[test]
fn a_read_only_file_is_not_replaced() {
    let room = Room::new();
    let mut permissions = fs::metadata(room.path("out.png")).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(room.path("out.png"), permissions).unwrap();
    let outcome = room.run(["render", "scene.toml", "-o", "out.png"]);
    assert_eq!(outcome.code, Some(1));
    assert!(outcome.stderr.contains("out.png: this file is read-only"), "{}", outcome.stderr);
    assert_eq!(room.read("out.png"), KNOWN);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told_and_leaves_the_other_outputs_whole() {
    let room = Room::new();
    let outcome = room.run(["render", "scene.toml", "-o", "out.png", "--make-size", "64", "--stats", "/dev/full"]);
    assert_eq!(outcome.code, Some(1));
    assert!(outcome.stderr.contains("error: /dev/full: cannot write"), "{}", outcome.stderr);
    assert_eq!(room.picture("out.png").dimensions(), (64, 48));

    std::os::unix::fs::symlink("/dev/full", room.path("full.png")).unwrap();
    let outcome = room.run(["render", "scene.toml", "-o", "full.png", "--make-size", "64"]);
    assert_eq!(outcome.code, Some(1));
    assert!(outcome.stderr.contains("error: full.png: cannot write"), "{}", outcome.stderr);
}

#[cfg(not(feature = "view"))]
#[test]
fn a_build_without_a_window_says_how_to_get_one() {
    check(&[case("view scene.toml --technique steep", 1, &["this build has no window", "--features view"])]);
}
