//! Every shader that can be composed is valid, and every language that naga writes can say it.

use naga::back;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use relievo_map::Wrap;
use relievo_march::{Shadow, Technique};
use relievo_shader::{ComposeError, Composer, Permutation, module_names, module_source, shader_source};

/// A fragment stage that calls both functions of the interface, so that the languages without free functions have a shader.
const PROBE: &str = "//! #import march
//! #import shadow
@group(0) @binding(0) var relievo_heights: texture_2d<f32>;
@group(0) @binding(1) var<uniform> options: RelievoMarchOptions;
@group(0) @binding(2) var relievo_pyramid: texture_2d<u32>;
@group(0) @binding(3) var relievo_cones: texture_2d<u32>;

@fragment
fn probe(@location(0) uv: vec2f, @location(1) view: vec3f) -> @location(0) vec4f {
    let field = relievo_height_field(0.0, 3);
    let record = relievo_march(field, RelievoRay(uv, view.xy, view.z), options);
    let shadow = relievo_shadow(field, RelievoRay(record.uv, view.yx, view.z), record.depth, options);
    return vec4f(record.uv, record.depth, shadow.factor);
}
";

fn permutations() -> Vec<Permutation> {
    let mut all = Vec::new();
    for technique in Technique::ALL {
        for shadow in Shadow::ALL {
            for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
                for eight_bit in [false, true] {
                    all.push(Permutation { technique, shadow, wrap, eight_bit, stretched: eight_bit });
                }
            }
        }
    }
    all
}

fn validated(wgsl: &str) -> Result<(naga::Module, ModuleInfo), String> {
    let module = naga::front::wgsl::parse_str(wgsl).map_err(|error| error.emit_to_string(wgsl))?;
    // No capability beyond what WebGL2 has.
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .map_err(|error| error.emit_to_string(wgsl))?;
    Ok((module, info))
}

fn probe(permutation: &Permutation) -> String {
    let mut composer = Composer::new(permutation);
    composer.add("probe", PROBE);
    composer.compose("probe").unwrap()
}

fn to_glsl(module: &naga::Module, info: &ModuleInfo, stage: naga::ShaderStage, entry_point: &str) -> String {
    let options = back::glsl::Options {
        version: back::glsl::Version::Embedded { version: 300, is_webgl: true },
        ..back::glsl::Options::default()
    };
    let pipeline =
        back::glsl::PipelineOptions { shader_stage: stage, entry_point: entry_point.to_owned(), multiview: None };
    let mut text = String::new();
    back::glsl::Writer::new(&mut text, module, info, &options, &pipeline, naga::proc::BoundsCheckPolicies::default())
        .unwrap()
        .write()
        .unwrap();
    text
}

fn to_hlsl(module: &naga::Module, info: &ModuleInfo) -> String {
    let mut text = String::new();
    let options = back::hlsl::Options::default();
    let pipeline = back::hlsl::PipelineOptions::default();
    back::hlsl::Writer::new(&mut text, &options, &pipeline).write(module, info, None).unwrap();
    text
}

fn to_msl(module: &naga::Module, info: &ModuleInfo) -> String {
    let options = back::msl::Options { lang_version: (2, 0), ..back::msl::Options::default() };
    back::msl::write_string(module, info, &options, &back::msl::PipelineOptions::default()).unwrap().0
}

fn to_spirv(module: &naga::Module, info: &ModuleInfo) -> Vec<u32> {
    back::spv::write_vec(module, info, &back::spv::Options::default(), None).unwrap()
}

#[test]
fn every_permutation_is_valid_and_can_be_said_in_every_shading_language() {
    let permutations = permutations();
    assert_eq!(permutations.len(), 12 * 4 * 3 * 2);
    for permutation in permutations {
        let (module, info) =
            validated(&probe(&permutation)).unwrap_or_else(|error| panic!("{permutation:?}:\n{error}"));
        assert!(to_glsl(&module, &info, naga::ShaderStage::Fragment, "probe").contains("relievo_march("));
        assert!(to_hlsl(&module, &info).contains("relievo_march("));
        assert!(to_msl(&module, &info).contains("relievo_march("));
        assert!(to_spirv(&module, &info).len() > 100);
    }
}

#[test]
fn the_compute_kernels_are_valid_where_there_is_compute() {
    for permutation in permutations() {
        for kernel in ["compute_march", "compute_shadow", "compute_tile", "pyramid_build", "halve"] {
            let wgsl = Composer::new(&permutation).compose(kernel).unwrap();
            let (module, info) = validated(&wgsl).unwrap_or_else(|error| panic!("{permutation:?} {kernel}:\n{error}"));
            to_hlsl(&module, &info);
            to_msl(&module, &info);
            to_spirv(&module, &info);
        }
    }
}

#[test]
fn a_shader_with_a_mistake_is_not_valid() {
    let good = probe(&Permutation::default());
    assert!(validated(&good).is_ok());
    assert!(validated(&good.replace("-> RelievoRecord {", "-> RelievoRay {")).is_err());
}

#[test]
fn shader_source_needs_only_the_textures_declared() {
    let heights = "@group(3) @binding(7) var relievo_heights: texture_2d<f32>;";
    let layered = Permutation { technique: Technique::Relief, ..Permutation::default() };
    let source = shader_source(&layered).unwrap();
    assert!(validated(&source).unwrap_err().contains("relievo_heights"));
    validated(&format!("{heights}\n{source}")).unwrap();
    // `cone` needs its cones, and `exact` its pyramid.
    let pyramid = "@group(3) @binding(8) var relievo_pyramid: texture_2d<u32>;";
    let source = shader_source(&Permutation { technique: Technique::Cone, ..Permutation::default() }).unwrap();
    assert!(validated(&format!("{heights}\n{pyramid}\n{source}")).unwrap_err().contains("relievo_cones"));
    let cones = "@group(3) @binding(9) var relievo_cones: texture_2d<u32>;";
    validated(&format!("{heights}\n{pyramid}\n{cones}\n{source}")).unwrap();
    let source = shader_source(&Permutation::default()).unwrap();
    assert!(validated(&format!("{heights}\n{source}")).unwrap_err().contains("relievo_pyramid"));
    validated(&format!("{heights}\n{pyramid}\n{source}")).unwrap();
}

#[test]
fn every_module_says_what_it_is_for_gives_and_needs() {
    for name in module_names() {
        let source = module_source(name).unwrap();
        assert!(source.starts_with("//! "), "{name}");
        assert!(source.contains("\n//! Gives "), "{name}");
        assert!(source.contains("eeds ") || source.contains("declares "), "{name}");
    }
}

#[test]
fn marches_take_no_derivatives_and_sample_no_implicit_level() {
    for name in module_names() {
        let source = module_source(name).unwrap();
        for word in ["textureSample(", "textureSampleBias(", "textureGather"] {
            assert!(!source.contains(word), "{name} has {word}");
        }
        let is_march =
            ["march", "shadow", "search", "walk", "span", "descent", "cone", "height", "one_sample", "record", "axes"];
        if is_march.iter().any(|start| name.starts_with(start)) {
            assert!(!source.contains("dpdx") && !source.contains("textureSample"), "{name}");
        }
    }
}

fn with(modules: &[(&'static str, &'static str)]) -> Composer {
    let mut composer = Composer::new(&Permutation::default());
    for &(name, source) in modules {
        composer.add(name, source);
    }
    composer
}

#[test]
fn a_module_imported_twice_stands_once_and_before_its_users() {
    let composer = with(&[
        ("root", "//! #import left\n//! #import right\nROOT\n"),
        ("left", "//! #import base\nLEFT\n"),
        ("right", "//! #import base\nRIGHT\n"),
        ("base", "BASE\n"),
    ]);
    let text = composer.compose("root").unwrap();
    let order: Vec<&str> =
        text.lines().filter(|line| line.chars().all(char::is_uppercase) && !line.is_empty()).collect();
    assert_eq!(order, ["BASE", "LEFT", "RIGHT", "ROOT"]);
}

#[test]
fn import_errors_name_the_file_and_the_line() {
    let error = with(&[("root", "\n//! #import nowhere\n")]).compose("root").unwrap_err();
    assert_eq!(error.to_string(), "root.wgsl:2: there is no shader module \"nowhere\" to import");

    let circle = with(&[("a", "//! #import b\n"), ("b", "// x\n// y\n//! #import c\n"), ("c", "//! #import b\n")]);
    let error = circle.compose("a").unwrap_err();
    assert_eq!(error.to_string(), "c.wgsl:1: the import goes round in a circle: b → c → b");

    let itself = with(&[("a", "//! #import a\n")]).compose("a").unwrap_err();
    assert!(matches!(itself, ComposeError::Circle { line: 1, .. }), "{itself}");

    for half in
        ["#import record\n", "// #import record\n", "//! #import\n", "//! #import two names\n", " //! #import record\n"]
    {
        let error = with(&[("root", half)]).compose("root").unwrap_err();
        assert_eq!(error, ComposeError::Malformed { module: "root".to_owned(), line: 1 }, "{half:?}");
    }

    let error = with(&[]).compose("nowhere").unwrap_err();
    assert_eq!(error.to_string(), "there is no shader module \"nowhere\"");
}
