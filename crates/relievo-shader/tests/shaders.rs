//! Every shader that can be composed is valid, and every language that naga writes can say it.

use relievo_map::Wrap;
use relievo_march::{Shadow, Technique};
use relievo_shader::translate::{GlslVersion, TranslateError, WgslModule};
use relievo_shader::{
    ComposeError, Composer, Permutation, TextureGlobal, module_names, module_source, naga_oil_modules, shader_source,
    shader_source_named,
};

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
                    all.push(Permutation {
                        technique,
                        shadow,
                        wrap,
                        eight_bit,
                        stretched: eight_bit,
                        without_pyramid: eight_bit && wrap == Wrap::Repeat,
                        nearest: eight_bit && wrap == Wrap::Mirror,
                        in_shells: technique == Technique::Exact && wrap != Wrap::Clamp,
                    });
                }
            }
        }
    }
    all
}

fn validated(wgsl: &str) -> Result<WgslModule, String> {
    // No capability beyond what WebGL2 has.
    WgslModule::parse(wgsl).map_err(|error| error.to_string())
}

fn probe(permutation: &Permutation) -> String {
    let mut composer = Composer::new(permutation);
    composer.add("probe", PROBE);
    composer.compose("probe").unwrap()
}

#[test]
fn every_permutation_is_valid_and_can_be_said_in_every_shading_language() {
    let permutations = permutations();
    assert_eq!(permutations.len(), 12 * 4 * 3 * 2);
    for permutation in permutations {
        let module = validated(&probe(&permutation)).unwrap_or_else(|error| panic!("{permutation:?}:\n{error}"));
        assert!(module.glsl("probe", GlslVersion::Es300).unwrap().contains("relievo_march("));
        assert!(module.hlsl().unwrap().contains("relievo_march("));
        assert!(module.msl((2, 0)).unwrap().contains("relievo_march("));
        assert!(module.spirv().unwrap().len() > 100);
    }
}

#[test]
fn the_compute_kernels_are_valid_where_there_is_compute() {
    for permutation in permutations() {
        let recipe = "//! #import fractal\nfn relievo_recipe_height(uv: vec2f, phase: f32) -> f32 {\n    \
                      return relievo_fractal(uv, RELIEVO_VALUE, RELIEVO_RIDGED, 0u, 2u, phase, 1.0);\n}\n";
        let kernels = ["compute_march", "compute_shadow", "compute_tile", "pyramid_build", "halve"];
        for kernel in kernels.into_iter().chain(["recipe_heights", "layer_heights"]) {
            let wgsl = Composer::new(&permutation).add("chosen_recipe", recipe).compose(kernel).unwrap();
            let module = validated(&wgsl).unwrap_or_else(|error| panic!("{permutation:?} {kernel}:\n{error}"));
            module.hlsl().unwrap();
            module.msl((2, 0)).unwrap();
            module.spirv().unwrap();
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
fn textures_are_those_that_the_source_needs() {
    for permutation in permutations() {
        let source = shader_source(&permutation).unwrap();
        validated(&(permutation.texture_declarations(1, 4) + &source)).unwrap();
        let needed: Vec<&str> = permutation.textures().iter().map(|global: &TextureGlobal| global.name).collect();
        let named = ["relievo_heights", "relievo_pyramid", "relievo_cones"]
            .into_iter()
            .filter(|name| source.lines().any(|line| line.split("//").next().is_some_and(|code| code.contains(name))));
        assert_eq!(needed, named.collect::<Vec<_>>(), "{permutation:?}");
    }
}

#[test]
fn two_reliefs_of_any_techniques_stand_in_one_shader() {
    for (first, second) in permutations().into_iter().zip(permutations().into_iter().rev()) {
        let wgsl = [
            first.texture_declarations(0, 0),
            shader_source(&first).unwrap(),
            shader_source_named(&second, "left_wall", 0, first.textures().len() as u32).unwrap(),
        ]
        .concat();
        let module = validated(&wgsl).unwrap_or_else(|error| panic!("{first:?} {second:?}:\n{error}"));
        assert_eq!(module.entry_points().count(), 0);
        assert!(wgsl.contains("fn left_wall_march(field: LeftWallHeightField"));
    }
    // The same names twice are no shader.
    let one = Permutation::default().texture_declarations(0, 0) + &shader_source(&Permutation::default()).unwrap();
    assert!(validated(&(one.clone() + &one)).is_err());
    let error = shader_source_named(&Permutation::default(), "Wall", 0, 0).unwrap_err();
    assert_eq!(error, ComposeError::InvalidPrefix("Wall".to_owned()));
}

#[test]
fn what_cannot_be_translated_says_why() {
    assert!(matches!(WgslModule::parse("fn f( {"), Err(TranslateError::Parse(_))));
    assert!(matches!(WgslModule::parse("fn f() -> f32 { }"), Err(TranslateError::Invalid(_))));
    let module = validated(&probe(&Permutation::default())).unwrap();
    let error = module.glsl("nowhere", GlslVersion::Es300).unwrap_err();
    assert_eq!(error.to_string(), "the shader has no entry point \"nowhere\"");
    // WebGL2 has no compute shaders.
    let kernel = validated(&Composer::new(&Permutation::default()).compose("compute_march").unwrap()).unwrap();
    let refused = kernel.glsl("relievo_march_rays", GlslVersion::Es300).unwrap_err();
    assert!(matches!(refused, TranslateError::Unsupported { language: "GLSL", .. }), "{refused}");
    assert!(kernel.glsl("relievo_march_rays", GlslVersion::Core430).is_ok());
}

#[test]
fn every_name_is_under_the_prefix() {
    let all = module_names().chain(["chosen_height", "chosen_technique", "chosen_shadow"]);
    let composer = Composer::new(&Permutation::default());
    for name in all {
        let source = module_source(name).map_or_else(|| composer.compose(name).unwrap(), str::to_owned);
        for line in source.lines() {
            let declared = ["fn ", "struct ", "const "].into_iter().find_map(|keyword| line.strip_prefix(keyword));
            let declared = declared.or_else(|| line.strip_prefix('@')?.split_once(" var").map(|(_, rest)| rest));
            let Some(declared) = declared else { continue };
            let declared = declared.trim_start_matches("<uniform>").trim_start_matches("<storage, read>");
            let declared = declared.trim_start_matches("<storage, read_write>").trim_start();
            assert!(["relievo_", "Relievo", "RELIEVO_"].iter().any(|p| declared.starts_with(p)), "{name}: {line}");
        }
    }
}

#[test]
fn modules_for_naga_oil_import_all_they_use_from_modules_before_them() {
    for permutation in permutations() {
        let modules = naga_oil_modules(&permutation, 2, 0).unwrap();
        assert_eq!(modules[0].import_path, "relievo::textures");
        let mut known = String::new();
        for module in &modules {
            let (head, body) = module.source.split_at(module.source.find("//!").unwrap_or(module.source.len()));
            let head = if head.is_empty() { &module.source } else { head };
            assert!(head.starts_with(&format!("#define_import_path {}\n", module.import_path)), "{head}");
            for line in head.lines().filter_map(|line| line.strip_prefix("#import ")) {
                let (path, names) = line.split_once("::{").unwrap();
                assert!(
                    modules.iter().take_while(|m| m.import_path != module.import_path).any(|m| m.import_path == path)
                );
                for name in names.trim_end_matches('}').split(", ") {
                    // naga_oil refuses names that end in a digit.
                    assert!(!name.ends_with(|c: char| c.is_ascii_digit()) && !name.contains("__"), "{name}");
                    assert!(known.contains(name) && module.source.matches(name).count() > 1, "{name}");
                }
            }
            assert!(!body.contains("#import"), "{body}");
            known.push_str(&module.source);
        }
        // All of them together are the shader again.
        let code = |line: &&str| !line.starts_with('#');
        let whole: String =
            modules.iter().flat_map(|m| m.source.lines().filter(code)).flat_map(|l| [l, "\n"]).collect();
        validated(&whole).unwrap();
    }
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
