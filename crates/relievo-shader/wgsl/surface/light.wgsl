//! Lights as seen from a point.
//!
//! Gives RelievoLight, RelievoIncomingLight, relievo_light_incoming, relievo_light_path, relievo_light_offset,
//! relievo_pixel_rotation.
//! Needs nothing else.
//! #import tangent
//! #import chosen_reflection

const RELIEVO_LIGHT_POINT: u32 = 0u;
const RELIEVO_LIGHT_DIRECTIONAL: u32 = 1u;
const RELIEVO_LIGHT_SPOT: u32 = 2u;

// How many points of a light with a radius are asked whether they are hidden.
const RELIEVO_PENUMBRA_SAMPLES: u32 = 16u;

struct RelievoLight {
    position: vec3f,
    kind: u32,
    // The way the light travels.
    direction: vec3f,
    radius: f32,
    // Times the intensity.
    color: vec3f,
    // Cosines of a spot's two angles.
    cos_inner: f32,
    cos_outer: f32,
    // How its shadow map is seen, as in View: of a point light, whose map has six faces, only `map_near` counts.
    map_window_offset: vec2f,
    map_eye: vec3f,
    map_near: f32,
    map_right: vec3f,
    map_far: f32,
    map_up: vec3f,
    // The first of its layers; below 0: it has none.
    map_layer: i32,
}

struct RelievoIncomingLight {
    // Unit vector to the light; 0 if no light arrives.
    direction: vec3f,
    distance: f32,
    color: vec3f,
}

// A way to a light, or to a point of one.
struct RelievoLightPath {
    // Unit vector; 0 if there is no way.
    direction: vec3f,
    distance: f32,
}

fn relievo_light_incoming(light: RelievoLight, point: vec3f) -> RelievoIncomingLight {
    if light.kind == RELIEVO_LIGHT_DIRECTIONAL {
        return RelievoIncomingLight(-light.direction, RELIEVO_FAR_LIGHT, light.color);
    }
    let to_light = light.position - point;
    let distance = length(to_light);
    // Punctual lights of glTF fall off with the squared distance; the tutorials' do not fall off.
    let falloff = select(1.0, 1.0 / max(distance * distance, 1e-8), RELIEVO_REFLECTION_IS_PHYSICAL);
    var incoming = RelievoIncomingLight(relievo_normalized_or(to_light, vec3f(0.0)), distance, light.color * falloff);
    if light.kind == RELIEVO_LIGHT_SPOT {
        let cos = -dot(incoming.direction, light.direction);
        let x = clamp((cos - light.cos_outer) / (light.cos_inner - light.cos_outer), 0.0, 1.0);
        incoming.color *= x * x * (3.0 - 2.0 * x);
    }
    return incoming;
}

// The way to point `i` of RELIEVO_PENUMBRA_SAMPLES on the light's disc, on Vogel's spiral (1979).
fn relievo_light_path(light: RelievoLight, incoming: RelievoIncomingLight, i: u32, rotation: f32) -> RelievoLightPath {
    let directional = light.kind == RELIEVO_LIGHT_DIRECTIONAL;
    let path = incoming.direction * select(incoming.distance, 1.0, directional)
        + relievo_light_offset(light, incoming, i, rotation);
    return RelievoLightPath(relievo_normalized_or(path, vec3f(0.0)), select(length(path), RELIEVO_FAR_LIGHT, directional));
}

// The way from the disc's middle to that point; of a directional light, at distance 1.
fn relievo_light_offset(light: RelievoLight, incoming: RelievoIncomingLight, i: u32, rotation: f32) -> vec3f {
    let r = sqrt((f32(i) + 0.5) / f32(RELIEVO_PENUMBRA_SAMPLES)) * light.radius;
    let angle = f32(i) * 2.3999632 + rotation;
    return relievo_any_orthonormal(incoming.direction) * (cos(angle) * r)
        + relievo_any_orthonormal_second(incoming.direction) * (sin(angle) * r);
}

// An angle that differs from pixel to pixel, so that a penumbra shows as fine grain instead of bands (interleaved gradient
// noise, Jimenez 2014).
fn relievo_pixel_rotation(pixel: vec2f) -> f32 {
    let inner = fract(0.06711056 * pixel.x + 0.00583715 * pixel.y);
    return fract(52.982918 * inner) * 6.2831853;
}
