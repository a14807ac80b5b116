//! The shader files, embedded.

/// Names and texts of all modules, in the order in which a reader meets them.
macro_rules! modules {
    ($($folder:literal: $($name:literal)*;)*) => {
        &[$($(($name, include_str!(concat!("../wgsl/", $folder, "/", $name, ".wgsl")))),*),*]
    };
}

pub(crate) const MODULES: &[(&str, &str)] = modules! {
    "march": "record" "axes";
    "wrap": "wrap_repeat" "wrap_clamp" "wrap_mirror";
    "march": "lerp_exact" "lerp_8_bit" "height" "bounds" "search" "one_sample" "walk" "path_line" "path_curve" "span" "descent" "medium" "beam" "cone" "march_flat" "march_basic" "march_offset_limiting" "march_unity_offset" "march_steep" "march_binary" "march_relief" "march_occlusion" "march_contact" "march_cone" "march_exact" "march" "shell";
    "shadow": "shadow_none" "shadow_layers" "shadow_hard" "shadow_soft" "shadow_exact" "shadow";
    "recipe": "noise" "fractal";
    "compute": "compute_job" "compute_march" "compute_shadow" "compute_tile" "pyramid_build" "halve" "recipe_heights" "layer_heights";
    "surface": "tangent" "material_sample" "blinn_phong" "pbr" "light" "color";
    "pass": "output_as_is" "output_encoded" "output_decoded" "output_raw";
    "surface": "scene" "footprint" "surface" "mean_normal" "normal_mesh" "normal_map" "normal_height" "shells";
    "pass": "vertex" "shell_vertex";
    "surface": "visible" "visible_plane" "shell_found" "shell_single" "shell_walk" "visible_shell";
    "pass": "depth_of_hit" "depth_of_polygon" "shadow_caster";
    "surface": "casters" "cast_shadow" "environment";
    "pass": "background";
    "surface": "mist_light" "column_wall" "shade" "coverage";
    "pass": "fragment_color" "fragment_depth" "measure_surface" "measure_light" "average";
    "surface": "mist";
    "pass": "mist_vertex" "mist_color" "mist_shadow";
};

/// Names of all shader modules.
pub fn module_names() -> impl Iterator<Item = &'static str> {
    MODULES.iter().map(|&(name, _)| name)
}

/// Text of the shader module with this name (the file's name without `.wgsl`), imports not resolved.
#[must_use]
pub fn module_source(name: &str) -> Option<&'static str> {
    MODULES.iter().find(|module| module.0 == name).map(|&(_, source)| source)
}
