//! A material's maps and settings, and the object it is on.
//!
//! Gives surface, object, surface_texels, surface_field, surface_march; declares their bindings, groups 1 and 2.
//! #import height
//! #import material_sample
//! #import footprint
//! #import chosen_drawing

// Heights have at most 17 mip levels, two ranges to an element.
const RANGES: u32 = 9u;

struct Surface {
    how: March,
    base_color: vec3f,
    roughness: f32,
    metallic: f32,
    // The full depth: in object units if `depth_is_absolute` is not 0, else as a fraction of a repeat along u.
    depth: f32,
    depth_is_absolute: u32,
    last_level: i32,
    // A stored normal's component times x plus y.
    normal_decode: vec2f,
    height_step: f32,
    // Not 0: beyond the object's texture range the border stretches, though the maps tile inside.
    stretched: u32,
    // Not 0: maps have mip levels.
    levels: u32,
    // The material's place in the scene.
    number: u32,
    ranges: array<vec4f, RANGES>,
}

struct Object {
    // Object to scene without translation, transposed.
    transposed: mat3x3f,
    // Upper corner of the texture range.
    repeat: vec2f,
    // Its place in the scene, plus 1.
    number: u32,
}

@group(1) @binding(0) var<uniform> surface: Surface;
@group(1) @binding(1) var relief_heights: texture_2d<f32>;
@group(1) @binding(2) var base_color_map: texture_2d<f32>;
@group(1) @binding(3) var normal_map: texture_2d<f32>;
@group(1) @binding(4) var roughness_map: texture_2d<f32>;
@group(1) @binding(5) var metallic_map: texture_2d<f32>;
@group(1) @binding(6) var ao_map: texture_2d<f32>;
@group(1) @binding(7) var map_sampler: sampler;
@group(1) @binding(8) var relief_pyramid: texture_2d<u32>;
@group(1) @binding(9) var relief_cones: texture_2d<u32>;
@group(2) @binding(0) var<uniform> object: Object;

// Where a map of this size is sampled at a mip level.
fn surface_uv(uv: vec2f, lod: f32, size: vec2f) -> vec2f {
    if surface.stretched == 0u {
        return uv;
    }
    // Half a texel of the coarser level inside, where no neighbour tile mixes in.
    let inset = min(0.5 * exp2(ceil(lod)) / size, 0.5 * object.repeat);
    return min(max(uv, inset), object.repeat - inset);
}

// A map over the footprint around `uv`.
fn surface_sample(map: texture_2d<f32>, uv: vec2f, footprint: Footprint) -> vec4f {
    let size = vec2f(textureDimensions(map));
    if !LOD {
        let inside = surface_uv(uv, footprint_lod(footprint, size), size);
        return textureSampleGrad(map, map_sampler, inside, footprint.dx, footprint.dy);
    }
    let probes = footprint_probes(footprint, size);
    var sum = vec4f(0.0);
    for (var i = 0u; i < probes.count; i++) {
        let inside = surface_uv(probe_uv(probes, uv, i), probes.lod, size);
        sum += textureSampleLevel(map, map_sampler, inside, probes.lod);
    }
    return sum / f32(probes.count);
}

fn surface_texels(uv: vec2f, footprint: Footprint) -> Texels {
    return Texels(
        surface.base_color * surface_sample(base_color_map, uv, footprint).rgb,
        surface.roughness * surface_sample(roughness_map, uv, footprint).r,
        surface.metallic * surface_sample(metallic_map, uv, footprint).r,
        surface_sample(ao_map, uv, footprint).r,
    );
}

// The height map at a level of detail.
fn surface_level(lod: f32) -> Field {
    var field = height_field(lod, surface.last_level);
    let pair = surface.ranges[field.level / 2];
    field.range = select(pair.xy, pair.zw, field.level % 2 != 0);
    field.step = surface.height_step;
    if surface.stretched != 0u {
        return height_stretched(field, object.repeat);
    }
    return field;
}

// The height map as it is marched.
fn surface_field(footprint: Footprint) -> Field {
    let size = vec2f(textureDimensions(relief_heights));
    return surface_level(select(0.0, footprint_march_lod(footprint, size), LOD));
}

// The settings of the march on this object.
fn surface_march() -> March {
    var how = surface.how;
    how.bounds = vec4f(0.0, 0.0, object.repeat);
    return how;
}

// The full depth in scene units.
fn surface_depth(normal: vec3f, jacobian: vec4f) -> f32 {
    let n = normal / max(length(normal), 1e-30);
    return surface.depth * select(length(jacobian.xy), length(object.transposed * n), surface.depth_is_absolute != 0u);
}
