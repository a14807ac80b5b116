//! A material's maps and settings, and the object it is on.
//!
//! Gives surface, object, Footprint, surface_texels, surface_field, surface_march; declares their bindings, groups 1 and 2.
//! #import height
//! #import texels

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
    // Not 0: march the mip level that fits the pixel's footprint.
    lod: u32,
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

// How far a step of one pixel goes on the surface, in texture repeats.
struct Footprint {
    dx: vec2f,
    dy: vec2f,
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

// The mip level at which the longer gradient spans one texel.
fn footprint_lod(footprint: Footprint, size: vec2f) -> f32 {
    let longer = max(length(footprint.dx * size), length(footprint.dy * size));
    return log2(max(longer, 1.0));
}

// Where a map of this size is sampled.
fn surface_uv(uv: vec2f, footprint: Footprint, size: vec2f) -> vec2f {
    if surface.stretched == 0u {
        return uv;
    }
    // Half a texel of the coarser level inside, where no neighbour tile mixes in.
    let texel = exp2(ceil(footprint_lod(footprint, size)));
    let inset = min(0.5 * texel / size, 0.5 * object.repeat);
    return min(max(uv, inset), object.repeat - inset);
}

fn surface_texels(uv: vec2f, footprint: Footprint) -> Texels {
    let dx = footprint.dx;
    let dy = footprint.dy;
    let color_uv = surface_uv(uv, footprint, vec2f(textureDimensions(base_color_map)));
    let roughness_uv = surface_uv(uv, footprint, vec2f(textureDimensions(roughness_map)));
    let metallic_uv = surface_uv(uv, footprint, vec2f(textureDimensions(metallic_map)));
    let ao_uv = surface_uv(uv, footprint, vec2f(textureDimensions(ao_map)));
    return Texels(
        surface.base_color * textureSampleGrad(base_color_map, map_sampler, color_uv, dx, dy).rgb,
        surface.roughness * textureSampleGrad(roughness_map, map_sampler, roughness_uv, dx, dy).r,
        surface.metallic * textureSampleGrad(metallic_map, map_sampler, metallic_uv, dx, dy).r,
        textureSampleGrad(ao_map, map_sampler, ao_uv, dx, dy).r,
    );
}

fn surface_field(footprint: Footprint) -> Field {
    let size = vec2f(textureDimensions(relief_heights));
    var field = height_field(select(0.0, footprint_lod(footprint, size), surface.lod != 0u), surface.last_level);
    let pair = surface.ranges[field.level / 2];
    field.range = select(pair.xy, pair.zw, field.level % 2 != 0);
    field.step = surface.height_step;
    if surface.stretched != 0u {
        return height_stretched(field, object.repeat);
    }
    return field;
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
