use relievo_map::Wrap;
use relievo_march::{Shadow, Technique};

/// Choices that a shader is composed with: one pipeline's worth.
///
/// All else, layers and bounds and the like, is in `RelievoMarchOptions` of the shader (see [`crate::MarchUniforms`]) and can
/// change from ray to ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Permutation {
    /// Technique of `relievo_march`.
    pub technique: Technique,
    /// Self-shadow of `relievo_shadow`.
    pub shadow: Shadow,
    /// Continuation of the height map beyond its borders.
    pub wrap: Wrap,
    /// True if the full-size height map is filtered in 8-bit arithmetic; see `ReliefMap::filtered_in_8_bits` of relievo-march.
    pub eight_bit: bool,
    /// True if a field's border may stretch beyond the repeats of an object (`edge = "clamp"` on several tiles), by
    /// `relievo_height_stretched`.
    pub stretched: bool,
    /// True if `exact`, march and shadow, crosses every cell instead of asking the max pyramid: the same hits, to measure
    /// what the pyramid saves.
    pub without_pyramid: bool,
    /// True if texels are columns with flat tops; see `ReliefMap::nearest` of relievo-march.
    pub nearest: bool,
    /// True if rays are those of shells, curved as seen from the map; `relievo_march` follows straight ones then, at a higher price.
    pub in_shells: bool,
}

impl Permutation {
    /// Modules that stand for the choices: their names and texts.
    pub(crate) fn choices(&self) -> Vec<(&'static str, String)> {
        vec![
            ("chosen_height", self.chosen_height()),
            ("chosen_technique", self.chosen_technique()),
            ("chosen_shadow", self.chosen_shadow()),
            ("chosen_path", format!("//! #import {}\n", if self.in_shells { "path_curve" } else { "path_line" })),
        ]
    }

    fn chosen_height(&self) -> String {
        let wrap = match self.wrap {
            Wrap::Repeat => "wrap_repeat",
            Wrap::Clamp => "wrap_clamp",
            Wrap::Mirror => "wrap_mirror",
        };
        let (stretches, nearest) = (self.stretched, self.nearest);
        // A pyramid has the maxima of cells between texel centres.
        let without_pyramid = self.without_pyramid || nearest;
        let lerp = if self.eight_bit { "lerp_8_bit" } else { "lerp_exact" };
        format!(
            "//! #import {wrap}\n//! #import {lerp}\n\
             const RELIEVO_FIELD_STRETCHES: bool = {stretches};\n\
             const RELIEVO_WITHOUT_PYRAMID: bool = {without_pyramid};\n\
             const RELIEVO_NEAREST: bool = {nearest};\n\
             fn relievo_height_wrap(i: i32, n: i32) -> i32 {{ return relievo_{wrap}(i, n); }}\n\
             fn relievo_axis_cell(i: i32, n: i32) -> vec2i {{ return relievo_{wrap}_axis_cell(i, n); }}\n\
             fn relievo_cells_to_exit(index: i32, step: i32, bit_shift: u32, n: i32) -> i32 {{\n    \
             return relievo_{wrap}_cells_to_exit(index, step, bit_shift, n);\n}}\n\
             fn relievo_axis_cell_beyond(index: i32, mirror_sign: i32, n: i32) -> vec2i {{\n    \
             return relievo_{wrap}_axis_cell_beyond(index, mirror_sign, n);\n}}\n\
             fn relievo_cells_in_reach(i: i32, step: i32, n: i32) -> i32 {{ return relievo_{wrap}_cells_in_reach(i, step, n); }}\n\
             fn relievo_last_texel(n: i32) -> i32 {{ return relievo_{wrap}_last_texel(n); }}\n\
             fn relievo_mirror_sign(uv: vec2f) -> vec2f {{ return relievo_{wrap}_mirror_sign(uv); }}\n\
             fn relievo_height_lerp(a: f32, b: f32, t: f32) -> f32 {{ return relievo_{lerp}(a, b, t); }}\n"
        )
    }

    fn chosen_technique(&self) -> String {
        // Modules are named after their techniques: one that has none yet is an error of the composer.
        let march = match self.technique {
            Technique::None | Technique::Normal => "march_flat".to_owned(),
            technique => format!("march_{}", technique.name().replace('-', "_")),
        };
        let marches = march != "march_flat";
        let entry = if self.technique == Technique::Exact { ", entry" } else { "" };
        format!(
            "//! #import {march}\n\
             const RELIEVO_TECHNIQUE_MARCHES: bool = {marches};\n\
             fn relievo_march_by_technique(\n    \
             field: RelievoHeightField, ray: RelievoRay, options: RelievoMarchOptions, entry: f32,\n\
             ) -> RelievoRecord {{\n    \
             return relievo_{march}(field, ray, options{entry});\n}}\n"
        )
    }

    fn chosen_shadow(&self) -> String {
        let shadow = format!("shadow_{}", self.shadow.name());
        let (cast, exact) = (self.shadow != Shadow::None, self.shadow == Shadow::Exact);
        format!(
            "//! #import {shadow}\n\
             const RELIEVO_SHADOW_IS_CAST: bool = {cast};\n\
             const RELIEVO_SHADOW_IS_EXACT: bool = {exact};\n\
             fn relievo_shadow_by_kind(\n    \
             field: RelievoHeightField, light: RelievoRay, depth: f32, reach: f32, options: RelievoMarchOptions,\n\
             ) -> RelievoShadowRecord {{\n    \
             return relievo_{shadow}(field, light, depth, reach, options);\n}}\n"
        )
    }
}
