//! The shader files, embedded.

/// Names and texts of all modules, in the order in which a reader meets them.
macro_rules! modules {
    ($($name:literal)*) => {
        &[$(($name, include_str!(concat!("shaders/", $name, ".wgsl")))),*]
    };
}

pub(crate) const MODULES: &[(&str, &str)] = modules! {
    "record"
    "wrap_repeat" "wrap_clamp" "wrap_mirror"
    "lerp_exact" "lerp_8_bit"
    "height" "bounds"
    "search" "one_sample" "walk" "descent" "beam" "cone"
    "march_flat" "march_basic" "march_offset_limiting" "march_unity_offset" "march_steep" "march_binary"
    "march_relief" "march_occlusion" "march_contact" "march_cone" "march_exact"
    "march"
    "shadow_none" "shadow_hard" "shadow_soft" "shadow_exact"
    "shadow"
    "compute_job" "compute_march" "compute_shadow" "compute_tile"
    "pyramid_build" "halve"
    "tangent" "texels" "blinn_phong" "pbr" "light" "color"
    "output_as_is" "output_encoded" "output_decoded" "output_raw"
    "scene" "footprint" "surface" "mean_normal" "normal_mesh" "normal_map" "normal_height"
    "vertex" "visible" "depth_of_hit" "depth_of_polygon" "shadow_caster"
    "casters" "cast_shadow" "environment" "background"
    "shade" "coverage" "fragment_color" "fragment_depth" "measure_surface" "measure_light" "average"
};

/// The names of all shader modules.
pub fn module_names() -> impl Iterator<Item = &'static str> {
    MODULES.iter().map(|&(name, _)| name)
}

/// The text of a shader module by its name, the file's name without `.wgsl`: as it stands, imports not resolved.
#[must_use]
pub fn module_source(name: &str) -> Option<&'static str> {
    MODULES.iter().find(|module| module.0 == name).map(|&(_, source)| source)
}
