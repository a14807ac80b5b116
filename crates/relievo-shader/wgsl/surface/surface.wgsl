//! A material's maps and settings, and the object it is on.
//!
//! Gives relievo_surface, relievo_object, relievo_surface_sample_material, relievo_surface_field,
//! relievo_surface_options; declares their bindings, groups 1 and 2.
//! #import height
//! #import material_sample
//! #import footprint
//! #import chosen_drawing

// Heights have at most 17 mip levels, two ranges to an element.
const RELIEVO_MAX_RANGE_PAIRS: u32 = 9u;

struct RelievoSurface {
    options: RelievoMarchOptions,
    base_color: vec3f,
    roughness: f32,
    metallic: f32,
    // The full depth: in object units if `depth_is_absolute` is not 0, else as a fraction of a repeat along u.
    depth: f32,
    depth_is_absolute: u32,
    last_level: i32,
    height_step: f32,
    // Not 0: beyond the object's texture range the border stretches, though the maps tile inside.
    stretched: u32,
    // Not 0: maps have mip levels.
    levels: u32,
    // The material's place in the scene.
    number: u32,
    // 1, or −1 for the back of a relief: the factor on x and y of the normal map's normals.
    normal_sign: f32,
    ranges: array<vec4f, RELIEVO_MAX_RANGE_PAIRS>,
}

struct RelievoObject {
    // Object to scene without translation, transposed.
    transposed: mat3x3f,
    // Its place in the scene, plus 1.
    number: u32,
}

// The texture range of the chart that this fragment is on: lower and upper corner. Set first, by relievo_visible_point.
var<private> relievo_chart_range: vec4f;

@group(1) @binding(0) var<uniform> relievo_surface: RelievoSurface;
@group(1) @binding(1) var relievo_heights: texture_2d<f32>;
@group(1) @binding(2) var relievo_base_color_map: texture_2d<f32>;
@group(1) @binding(3) var relievo_normal_map: texture_2d<f32>;
@group(1) @binding(4) var relievo_roughness_map: texture_2d<f32>;
@group(1) @binding(5) var relievo_metallic_map: texture_2d<f32>;
@group(1) @binding(6) var relievo_ao_map: texture_2d<f32>;
@group(1) @binding(7) var relievo_map_sampler: sampler;
@group(1) @binding(8) var relievo_pyramid: texture_2d<u32>;
@group(1) @binding(9) var relievo_cones: texture_2d<u32>;
@group(2) @binding(0) var<uniform> relievo_object: RelievoObject;

// Where a map of this size is sampled at a mip level.
fn relievo_surface_uv(uv: vec2f, lod: f32, size: vec2f) -> vec2f {
    if relievo_surface.stretched == 0u {
        return uv;
    }
    // Half a texel of the coarser level inside, where no neighbour tile mixes in.
    let range = relievo_chart_range;
    let inset = min(0.5 * exp2(ceil(lod)) / size, 0.5 * (range.zw - range.xy));
    return min(max(uv, range.xy + inset), range.zw - inset);
}

// A map over the footprint around `uv`.
fn relievo_surface_sample(map: texture_2d<f32>, uv: vec2f, footprint: RelievoFootprint) -> vec4f {
    let size = vec2f(textureDimensions(map));
    if !RELIEVO_LOD {
        let inside = relievo_surface_uv(uv, relievo_footprint_lod(footprint, size), size);
        return textureSampleGrad(map, relievo_map_sampler, inside, footprint.dx, footprint.dy);
    }
    let probes = relievo_footprint_probes(footprint, size);
    var sum = vec4f(0.0);
    for (var i = 0u; i < probes.count; i++) {
        let inside = relievo_surface_uv(relievo_probe_uv(probes, uv, i), probes.lod, size);
        sum += textureSampleLevel(map, relievo_map_sampler, inside, probes.lod);
    }
    return sum / f32(probes.count);
}

fn relievo_surface_sample_material(uv: vec2f, footprint: RelievoFootprint) -> RelievoMaterialSample {
    return RelievoMaterialSample(
        relievo_surface.base_color * relievo_surface_sample(relievo_base_color_map, uv, footprint).rgb,
        relievo_surface.roughness * relievo_surface_sample(relievo_roughness_map, uv, footprint).r,
        relievo_surface.metallic * relievo_surface_sample(relievo_metallic_map, uv, footprint).r,
        relievo_surface_sample(relievo_ao_map, uv, footprint).r,
    );
}

// The height map at a level of detail.
fn relievo_surface_level(lod: f32) -> RelievoHeightField {
    var field = relievo_height_field(lod, relievo_surface.last_level);
    let pair = relievo_surface.ranges[field.level / 2];
    field.range = select(pair.xy, pair.zw, field.level % 2 != 0);
    field.step = relievo_surface.height_step;
    if relievo_surface.stretched != 0u {
        return relievo_height_stretched(field, relievo_chart_range);
    }
    return field;
}

// The height map as it is marched.
fn relievo_surface_field(footprint: RelievoFootprint) -> RelievoHeightField {
    let size = vec2f(textureDimensions(relievo_heights));
    return relievo_surface_level(select(0.0, relievo_footprint_march_lod(footprint, size), RELIEVO_LOD));
}

// The settings of the march on this chart.
fn relievo_surface_options() -> RelievoMarchOptions {
    var options = relievo_surface.options;
    options.bounds = relievo_chart_range;
    return options;
}

// The full depth in scene units, where a repeat along u has this length on the chart.
fn relievo_surface_depth(direction: vec3f, repeat_length: f32) -> f32 {
    let n = direction / max(length(direction), 1e-30);
    return relievo_surface.depth * select(repeat_length, length(relievo_object.transposed * n), relievo_surface.depth_is_absolute != 0u);
}
