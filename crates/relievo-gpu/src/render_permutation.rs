use relievo_scene::ShadingModel;

use crate::{ComposeError, Composer, Permutation};

/// Everything that one render pipeline is composed of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct RenderPermutation {
    pub(crate) march: Permutation,
    pub(crate) model: Model,
    pub(crate) normal: NormalSource,
    pub(crate) output: Output,
    pub(crate) writes_depth: bool,
    /// What may throw a shadow on it, beside the relief that is marched.
    pub(crate) casters: Casters,
    /// Whether lights with a radius throw soft shadows.
    pub(crate) softens: bool,
    /// Whether light comes from all around.
    pub(crate) surroundings: bool,
    /// Whether the borders of clipped reliefs are multisampled.
    pub(crate) smooths_edges: bool,
    /// Seen from its front alone, as reliefs are.
    pub(crate) one_sided: bool,
    /// Real geometry instead of a march.
    pub(crate) displaced: bool,
    /// Whether maps and march have the detail that a pixel can show.
    pub(crate) lod: bool,
}

/// What is drawn of the same march.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Pass {
    /// Colour and depth.
    Color,
    /// Depth alone.
    Depth,
    /// As a light sees it: depth and object.
    Caster,
    /// Normal, distance, uv and cost instead of colour.
    MeasureSurface,
    /// Shadow and material instead of colour.
    MeasureLight,
}

/// What may throw a shadow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Casters {
    Nothing,
    /// The object itself.
    Itself,
    Everything,
}

/// [`ShadingModel`], for use in keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Model {
    BlinnPhong,
    Pbr,
}

impl From<ShadingModel> for Model {
    fn from(model: ShadingModel) -> Self {
        if model.is_physical() { Self::Pbr } else { Self::BlinnPhong }
    }
}

/// Where shading normals come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum NormalSource {
    Mesh,
    Map,
    ReliefMap,
}

/// How colours leave the shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Output {
    /// Clamped to 0..1.
    AsIs,
    /// Light as display numbers.
    Encoded,
    /// Display numbers as light.
    Decoded,
    /// Unchanged, for averaging.
    Raw,
}

impl RenderPermutation {
    /// The WGSL of both stages of a pass: entry points `vertex` and `fragment`.
    pub(crate) fn source(&self, pass: Pass) -> Result<String, ComposeError> {
        let mut composer = Composer::new(&self.march);
        composer.add("chosen_normal", self.chosen_normal());
        composer.add("chosen_reflection", chosen_reflection(self.model));
        composer.add("chosen_output", self.output.module());
        composer.add("chosen_drawing", self.chosen_drawing());
        composer.compose(match (pass, self.writes_depth) {
            (Pass::Color, false) => "fragment_color",
            (Pass::Color, true) => "fragment_depth",
            (Pass::Depth, false) => "depth_of_polygon",
            (Pass::Depth, true) => "depth_of_hit",
            (Pass::Caster, _) => "shadow_caster",
            (Pass::MeasureSurface, _) => "measure_surface",
            (Pass::MeasureLight, _) => "measure_light",
        })
    }

    fn chosen_drawing(&self) -> String {
        let casters = match self.casters {
            Casters::Nothing => "NONE",
            Casters::Itself => "ITSELF",
            Casters::Everything => "EVERYTHING",
        };
        let Self { writes_depth, softens, surroundings, smooths_edges, displaced, lod, .. } = self;
        format!(
            "//! #import casters\n\
             const WRITES_DEPTH: bool = {writes_depth};\n\
             const CASTERS: u32 = CASTERS_{casters};\n\
             const SHADOW_SOFTENS: bool = {softens};\n\
             const ENVIRONMENT_IS_SEEN: bool = {surroundings};\n\
             const SMOOTHS_EDGES: bool = {smooths_edges};\n\
             const IS_DISPLACED: bool = {displaced};\n\
             const LOD: bool = {lod};\n"
        )
    }

    fn chosen_normal(&self) -> String {
        let (module, function) = match self.normal {
            NormalSource::Mesh => ("normal_mesh", "normal_of_mesh"),
            NormalSource::Map => ("normal_map", "normal_of_map"),
            NormalSource::ReliefMap => ("normal_height", "normal_of_heights"),
        };
        format!(
            "//! #import {module}\n\
             fn normal_at(at: Tangent, field: Field, uv: vec2f, footprint: Footprint) -> MeanNormal {{\n    \
             return {function}(at, field, uv, footprint);\n}}\n"
        )
    }
}

/// The WGSL of the surroundings behind everything: entry points `vertex` and `fragment`.
pub(crate) fn background_source(model: ShadingModel, output: Output) -> Result<String, ComposeError> {
    let mut composer = Composer::new(&Permutation::default());
    composer.add("chosen_reflection", chosen_reflection(model.into()));
    composer.add("chosen_output", output.module());
    composer.compose("background")
}

/// The module `chosen_reflection`.
fn chosen_reflection(model: Model) -> String {
    let (module, call) = match model {
        Model::BlinnPhong => ("blinn_phong", "blinn_phong(texels, normal, toward, light, specular, shininess)"),
        Model::Pbr => ("pbr", "metallic_roughness(texels, normal, toward, light)"),
    };
    let physical = model == Model::Pbr;
    format!(
        "//! #import {module}\n\
         const REFLECTION_IS_PHYSICAL: bool = {physical};\n\
         fn reflection(\n    texels: Texels, normal: MeanNormal, toward: vec3f, light: vec3f, specular: f32, shininess: f32,\n\
         ) -> vec3f {{\n    return {call};\n}}\n"
    )
}

impl Output {
    /// The module `chosen_output`.
    pub(crate) fn module(self) -> String {
        let output = match self {
            Self::AsIs => "output_as_is",
            Self::Encoded => "output_encoded",
            Self::Decoded => "output_decoded",
            Self::Raw => "output_raw",
        };
        format!(
            "//! #import {output}\n\
             fn output_color(color: vec3f) -> vec3f {{ return {output}(color); }}\n"
        )
    }
}

#[cfg(test)]
mod tests {
    use naga::back;
    use naga::valid::{Capabilities, ValidationFlags, Validator};
    use relievo_map::Wrap;
    use relievo_march::{Shadow, Technique};

    use super::*;

    fn permutations() -> Vec<RenderPermutation> {
        let mut all = Vec::new();
        for technique in Technique::ALL {
            for shadow in Shadow::ALL {
                for (k, model) in [Model::BlinnPhong, Model::Pbr].into_iter().enumerate() {
                    for (n, normal) in
                        [NormalSource::Mesh, NormalSource::Map, NormalSource::ReliefMap].into_iter().enumerate()
                    {
                        for output in [Output::AsIs, Output::Encoded, Output::Decoded, Output::Raw] {
                            for writes_depth in [false, true] {
                                // Wrap modes and filters are independent of these: every march has them in another test.
                                let wrap = [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror][n];
                                let march =
                                    Permutation { technique, shadow, wrap, eight_bit: k == 0, stretched: k == 1 };
                                all.push(RenderPermutation {
                                    march,
                                    model,
                                    normal,
                                    output,
                                    writes_depth,
                                    casters: [Casters::Nothing, Casters::Itself, Casters::Everything][n],
                                    softens: shadow == Shadow::Exact,
                                    surroundings: k == 1,
                                    smooths_edges: output == Output::AsIs,
                                    one_sided: true,
                                    displaced: n == 1,
                                    lod: n == 0 || writes_depth,
                                });
                            }
                        }
                    }
                }
            }
        }
        all
    }

    #[test]
    fn every_pipeline_is_valid_and_can_be_said_in_every_shading_language() {
        let permutations = permutations();
        assert_eq!(permutations.len(), 12 * 4 * 2 * 3 * 4 * 2);
        for permutation in permutations {
            for pass in [Pass::Color, Pass::Depth, Pass::Caster, Pass::MeasureSurface, Pass::MeasureLight] {
                // Only colours leave in several ways.
                if pass != Pass::Color && permutation.output != Output::Raw {
                    continue;
                }
                let wgsl = permutation.source(pass).unwrap();
                let module = naga::front::wgsl::parse_str(&wgsl)
                    .unwrap_or_else(|error| panic!("{permutation:?}:\n{}", error.emit_to_string(&wgsl)));
                let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
                    .validate(&module)
                    .unwrap_or_else(|error| panic!("{permutation:?}:\n{}", error.emit_to_string(&wgsl)));
                for (stage, entry) in [(naga::ShaderStage::Vertex, "vertex"), (naga::ShaderStage::Fragment, "fragment")]
                {
                    let options = back::glsl::Options {
                        version: back::glsl::Version::Embedded { version: 300, is_webgl: true },
                        ..back::glsl::Options::default()
                    };
                    let pipeline = back::glsl::PipelineOptions {
                        shader_stage: stage,
                        entry_point: entry.to_owned(),
                        multiview: None,
                    };
                    let policies = naga::proc::BoundsCheckPolicies::default();
                    let mut text = String::new();
                    back::glsl::Writer::new(&mut text, &module, &info, &options, &pipeline, policies)
                        .unwrap()
                        .write()
                        .unwrap();
                }
                let (hlsl, options) = (back::hlsl::PipelineOptions::default(), back::hlsl::Options::default());
                let mut text = String::new();
                back::hlsl::Writer::new(&mut text, &options, &hlsl).write(&module, &info, None).unwrap();
                let options = back::msl::Options { lang_version: (2, 1), ..back::msl::Options::default() };
                back::msl::write_string(&module, &info, &options, &back::msl::PipelineOptions::default()).unwrap();
                back::spv::write_vec(&module, &info, &back::spv::Options::default(), None).unwrap();
            }
        }
    }
}
