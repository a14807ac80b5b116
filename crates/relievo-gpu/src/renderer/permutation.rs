use relievo_scene::{ColorSpace, ShadingModel};

use crate::{ComposeError, Composer, GpuError, Permutation};

/// The choices that one render pipeline is composed of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct RenderPermutation {
    pub(crate) march: Permutation,
    pub(crate) model: Model,
    pub(crate) normal: NormalSource,
    pub(crate) output: Output,
    pub(crate) writes_depth: bool,
    /// Objects that may throw a shadow on it, beside the relief that is marched.
    pub(crate) casters: Casters,
    /// True if lights with a radius throw soft shadows.
    pub(crate) softens: bool,
    /// True if light comes from all around.
    pub(crate) environment: bool,
    /// True if the borders of clipped reliefs are multisampled.
    pub(crate) smooths_edges: bool,
    /// True if seen from its front alone, as reliefs are.
    pub(crate) one_sided: bool,
    /// True if real geometry stands instead of a march.
    pub(crate) displaced: bool,
    /// True if maps and march have the detail that a pixel can show.
    pub(crate) lod: bool,
    /// That of the object.
    pub(crate) geometry: DrawnGeometry,
    /// True if mist dims the lights that shine on it.
    pub(crate) dimmed: bool,
}

/// Geometry that a surface is drawn by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum DrawnGeometry {
    /// The polygons themselves.
    Polygons,
    /// The lids of shells, and walls without a neighbor: from there rays walk from shell to shell.
    Lids,
    /// The far side of the hull around each shell, for an eye that may be inside, and for shells that rays cannot walk through.
    Hulls,
}

/// Kinds of passes over mist.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum MistPass {
    /// Colour, over what has been drawn.
    Color,
    /// The share of a light that passes to surfaces.
    Shadow,
}

/// Kinds of passes, all with the same march.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Pass {
    /// Colour and depth.
    Color,
    /// Depth alone.
    Depth,
    /// Depth and object, as a light sees them.
    Caster,
    /// Normal, distance, uv and cost instead of colour.
    MeasureSurface,
    /// Shadow and material instead of colour.
    MeasureLight,
}

/// Objects that may throw a shadow.
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

impl TryFrom<ShadingModel> for Model {
    type Error = GpuError;

    fn try_from(model: ShadingModel) -> Result<Self, GpuError> {
        match model {
            ShadingModel::BlinnPhong => Ok(Self::BlinnPhong),
            ShadingModel::Pbr => Ok(Self::Pbr),
            other => Err(GpuError::Scene(format!("the GPU does not know the shading model {other:?}"))),
        }
    }
}

/// Sources of shading normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum NormalSource {
    Mesh,
    Map,
    HeightField,
}

/// Encodings of colours as they leave the shader.
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
    /// The same for an object that is drawn so.
    pub(crate) fn drawn_by(&self, geometry: DrawnGeometry) -> Self {
        let march = Permutation { in_shells: geometry != DrawnGeometry::Polygons, ..self.march };
        Self { march, geometry, ..*self }
    }

    /// The WGSL of both stages of a pass: entry points `relievo_vertex` and `relievo_fragment`.
    pub(crate) fn source(&self, pass: Pass) -> Result<String, ComposeError> {
        let mut composer = self.composer();
        let drawn = if self.geometry == DrawnGeometry::Polygons { "coverage" } else { "visible_shell" };
        composer.add("chosen_geometry", format!("//! #import {drawn}\n"));
        let walked = self.geometry == DrawnGeometry::Lids;
        composer.add("chosen_shells", format!("const RELIEVO_SHELLS_ARE_WALKED: bool = {walked};\n"));
        composer.add("chosen_search", if walked { "//! #import shell_walk\n" } else { "//! #import shell_single\n" });
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

    /// The WGSL of both stages of a pass over mist: entry points `relievo_vertex` and `relievo_fragment`.
    pub(crate) fn mist_source(&self, pass: MistPass) -> Result<String, ComposeError> {
        self.composer().compose(match pass {
            MistPass::Color => "mist_color",
            MistPass::Shadow => "mist_shadow",
        })
    }

    /// A composer with all choices but that of the geometry.
    fn composer(&self) -> Composer {
        let mut composer = Composer::new(&self.march);
        composer.add("chosen_normal", self.chosen_normal());
        composer.add("chosen_reflection", chosen_reflection(self.model));
        composer.add("chosen_output", self.output.module());
        composer.add("chosen_drawing", self.chosen_drawing());
        composer.add("chosen_mist", self.chosen_mist());
        composer
    }

    /// Returns true if a pass looks up the lights that come past mist.
    pub(crate) fn looks_up_mist(&self, pass: Pass) -> bool {
        self.dimmed && matches!(pass, Pass::Color | Pass::MeasureSurface | Pass::MeasureLight)
    }

    fn chosen_mist(&self) -> String {
        let (import, share) = if self.dimmed {
            ("//! #import mist_light\n", "relievo_looked_up_past_mist(pixel, light)")
        } else {
            ("", "1.0")
        };
        format!("{import}fn relievo_light_past_mist(pixel: vec2f, light: u32) -> f32 {{ return {share}; }}\n")
    }

    fn chosen_drawing(&self) -> String {
        let casters = match self.casters {
            Casters::Nothing => "NONE",
            Casters::Itself => "ITSELF",
            Casters::Everything => "EVERYTHING",
        };
        let Self { writes_depth, softens, environment, smooths_edges, displaced, lod, .. } = self;
        format!(
            "//! #import casters\n\
             const RELIEVO_WRITES_DEPTH: bool = {writes_depth};\n\
             const RELIEVO_CASTERS: u32 = RELIEVO_CASTERS_{casters};\n\
             const RELIEVO_SHADOW_SOFTENS: bool = {softens};\n\
             const RELIEVO_ENVIRONMENT_IS_SEEN: bool = {environment};\n\
             const RELIEVO_SMOOTHS_EDGES: bool = {smooths_edges};\n\
             const RELIEVO_IS_DISPLACED: bool = {displaced};\n\
             const RELIEVO_LOD: bool = {lod};\n"
        )
    }

    fn chosen_normal(&self) -> String {
        let (module, function) = match self.normal {
            NormalSource::Mesh => ("normal_mesh", "relievo_normal_of_mesh"),
            NormalSource::Map => ("normal_map", "relievo_normal_of_map"),
            NormalSource::HeightField => ("normal_height", "relievo_normal_of_heights"),
        };
        format!(
            "//! #import {module}\n\
             fn relievo_normal_at(\n    \
             at: RelievoTangentFrame, field: RelievoHeightField, uv: vec2f, footprint: RelievoFootprint,\n\
             ) -> RelievoMeanNormal {{\n    \
             return {function}(at, field, uv, footprint);\n}}\n"
        )
    }
}

/// The WGSL of the environment behind everything: entry points `relievo_vertex` and `relievo_fragment`.
pub(crate) fn background_source(model: ShadingModel, output: Output) -> Result<String, GpuError> {
    let mut composer = Composer::new(&Permutation::default());
    composer.add("chosen_reflection", chosen_reflection(model.try_into()?));
    composer.add("chosen_output", output.module());
    Ok(composer.compose("background")?)
}

/// The module `chosen_reflection`.
fn chosen_reflection(model: Model) -> String {
    let (module, call) = match model {
        Model::BlinnPhong => {
            ("blinn_phong", "relievo_blinn_phong(material, normal, to_eye, light, specular, shininess)")
        }
        Model::Pbr => ("pbr", "relievo_metallic_roughness(material, normal, to_eye, light)"),
    };
    let physical = model == Model::Pbr;
    format!(
        "//! #import {module}\n\
         const RELIEVO_REFLECTION_IS_PHYSICAL: bool = {physical};\n\
         fn relievo_reflection(\n    \
         material: RelievoMaterialSample, normal: RelievoMeanNormal, to_eye: vec3f, light: vec3f, specular: f32, shininess: f32,\n\
         ) -> vec3f {{\n    return {call};\n}}\n"
    )
}

impl Output {
    /// The encoding for a target that encodes sRGB by itself, or does not.
    pub(crate) fn new(space: ColorSpace, target_encodes: bool) -> Self {
        match (space, target_encodes) {
            (ColorSpace::Linear, true) | (ColorSpace::Display, false) => Self::AsIs,
            (ColorSpace::Linear, false) => Self::Encoded,
            (ColorSpace::Display, true) => Self::Decoded,
        }
    }

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
             fn relievo_output_color(color: vec3f) -> vec3f {{ return relievo_{output}(color); }}\n"
        )
    }
}

#[cfg(test)]
mod tests {
    use relievo_map::Wrap;
    use relievo_march::{Shadow, Technique};
    use relievo_shader::translate::{GlslVersion, WgslModule};

    use super::*;

    fn permutations() -> Vec<RenderPermutation> {
        let mut all = Vec::new();
        for technique in Technique::ALL {
            for shadow in Shadow::ALL {
                for (k, model) in [Model::BlinnPhong, Model::Pbr].into_iter().enumerate() {
                    for (n, normal) in
                        [NormalSource::Mesh, NormalSource::Map, NormalSource::HeightField].into_iter().enumerate()
                    {
                        for output in [Output::AsIs, Output::Encoded, Output::Decoded, Output::Raw] {
                            for writes_depth in [false, true] {
                                // Wrap modes and filters are independent of these: every march has them in another test.
                                let wrap = [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror][n];
                                let march = Permutation {
                                    technique,
                                    shadow,
                                    wrap,
                                    eight_bit: k == 0,
                                    stretched: k == 1,
                                    ..Permutation::default()
                                };
                                // Shells are for `exact` alone, which has a hit to write.
                                let geometry = match (technique, writes_depth) {
                                    (Technique::Exact, true) if n == 0 => DrawnGeometry::Hulls,
                                    (Technique::Exact, true) => DrawnGeometry::Lids,
                                    _ => DrawnGeometry::Polygons,
                                };
                                let permutation = RenderPermutation {
                                    march,
                                    model,
                                    normal,
                                    output,
                                    writes_depth,
                                    casters: [Casters::Nothing, Casters::Itself, Casters::Everything][n],
                                    softens: shadow == Shadow::Exact,
                                    environment: k == 1,
                                    smooths_edges: output == Output::AsIs,
                                    one_sided: true,
                                    displaced: n == 1,
                                    lod: n == 0 || writes_depth,
                                    geometry: DrawnGeometry::Polygons,
                                    dimmed: n == 2,
                                };
                                all.push(permutation.drawn_by(geometry));
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
                let module = WgslModule::parse(&wgsl).unwrap_or_else(|error| panic!("{permutation:?}:\n{error}"));
                for entry in ["relievo_vertex", "relievo_fragment"] {
                    module.glsl(entry, GlslVersion::Es300).unwrap();
                }
                module.hlsl().unwrap();
                module.msl((2, 1)).unwrap();
                module.spirv().unwrap();
            }
        }
    }

    #[test]
    fn mist_is_valid_and_can_be_said_in_every_shading_language() {
        let exact = |permutation: &RenderPermutation| {
            permutation.march.technique == Technique::Exact && permutation.march.shadow == Shadow::Exact
        };
        let mut count = 0;
        for permutation in permutations().into_iter().filter(exact) {
            for pass in [MistPass::Color, MistPass::Shadow] {
                let wgsl = permutation.mist_source(pass).unwrap();
                let module = WgslModule::parse(&wgsl).unwrap_or_else(|error| panic!("{permutation:?}:\n{error}"));
                for entry in ["relievo_vertex", "relievo_fragment"] {
                    module.glsl(entry, GlslVersion::Es300).unwrap();
                }
                module.hlsl().unwrap();
                module.msl((2, 1)).unwrap();
                module.spirv().unwrap();
                count += 1;
            }
        }
        assert_eq!(count, 2 * 2 * 3 * 4 * 2);
    }
}
