use relievo_map::Wrap;
use relievo_march::{Shadow, Technique};

/// Which march a shader is composed with: one pipeline's worth of choices.
///
/// What is not chosen here, layers and bounds and the like, is in the shader's `MarchOptions` settings and can change from ray to
/// ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Permutation {
    /// What `relief_march` does.
    pub technique: Technique,
    /// What `relief_shadow` does.
    pub shadow: Shadow,
    /// What lies beyond the height map's borders.
    pub wrap: Wrap,
    /// Filter the full-size height map in 8-bit arithmetic; see `ReliefMap::filtered_in_8_bits` of relievo-march.
    pub eight_bit: bool,
    /// Whether a field's border may stretch beyond the repeats of an object (`edge = "clamp"` on several tiles): what
    /// `height_stretched` is for.
    pub stretched: bool,
}

impl Permutation {
    /// The modules that stand for the choices: their names and texts.
    pub(crate) fn choices(&self) -> Vec<(&'static str, String)> {
        vec![
            ("chosen_height", self.chosen_height()),
            ("chosen_technique", self.chosen_technique()),
            ("chosen_shadow", self.chosen_shadow()),
        ]
    }

    fn chosen_height(&self) -> String {
        let wrap = match self.wrap {
            Wrap::Repeat => "wrap_repeat",
            Wrap::Clamp => "wrap_clamp",
            Wrap::Mirror => "wrap_mirror",
        };
        let stretches = self.stretched;
        let lerp = if self.eight_bit { "lerp_8_bit" } else { "lerp_exact" };
        format!(
            "//! #import {wrap}\n//! #import {lerp}\n\
             const FIELD_STRETCHES: bool = {stretches};\n\
             fn height_wrap(i: i32, n: i32) -> i32 {{ return {wrap}(i, n); }}\n\
             fn height_place(i: i32, n: i32) -> vec2i {{ return {wrap}_place(i, n); }}\n\
             fn height_leave(index: i32, way: i32, shift: u32, n: i32) -> i32 {{\n    \
             return {wrap}_leave(index, way, shift, n);\n}}\n\
             fn height_beyond(index: i32, facing: i32, n: i32) -> vec2i {{\n    \
             return {wrap}_beyond(index, facing, n);\n}}\n\
             fn height_reach(i: i32, way: i32, n: i32) -> i32 {{ return {wrap}_reach(i, way, n); }}\n\
             fn height_last(n: i32) -> i32 {{ return {wrap}_last(n); }}\n\
             fn map_facing(uv: vec2f) -> vec2f {{ return {wrap}_facing(uv); }}\n\
             fn height_lerp(a: f32, b: f32, t: f32) -> f32 {{ return {lerp}(a, b, t); }}\n"
        )
    }

    fn chosen_technique(&self) -> String {
        let march = match self.technique {
            Technique::None | Technique::Normal => "march_flat",
            Technique::Basic => "march_basic",
            Technique::OffsetLimiting => "march_offset_limiting",
            Technique::UnityOffset => "march_unity_offset",
            Technique::Steep => "march_steep",
            Technique::Binary => "march_binary",
            Technique::Relief => "march_relief",
            Technique::Occlusion => "march_occlusion",
            Technique::Contact => "march_contact",
            Technique::Cone => "march_cone",
            Technique::Exact => "march_exact",
        };
        let marches = march != "march_flat";
        let entry = if self.technique == Technique::Exact { ", entry" } else { "" };
        format!(
            "//! #import {march}\n\
             const TECHNIQUE_MARCHES: bool = {marches};\n\
             fn technique_march(field: Field, ray: Ray, how: March, entry: f32) -> Record {{\n    \
             return {march}(field, ray, how{entry});\n}}\n"
        )
    }

    fn chosen_shadow(&self) -> String {
        let shadow = match self.shadow {
            Shadow::None => "shadow_none",
            Shadow::Hard => "shadow_hard",
            Shadow::Soft => "shadow_soft",
            Shadow::Exact => "shadow_exact",
        };
        let (cast, exact) = (self.shadow != Shadow::None, self.shadow == Shadow::Exact);
        format!(
            "//! #import {shadow}\n\
             const SHADOW_IS_CAST: bool = {cast};\n\
             const SHADOW_IS_EXACT: bool = {exact};\n\
             fn kind_shadow(field: Field, light: Ray, depth: f32, how: March) -> ShadowRecord {{\n    \
             return {shadow}(field, light, depth, how);\n}}\n"
        )
    }
}
