//! Lights as seen from a point.
//!
//! Gives Light, Incoming, light_incoming, light_sample, light_offset, pixel_turn.
//! Needs nothing else.
//! #import tangent
//! #import chosen_reflection

const LIGHT_POINT: u32 = 0u;
const LIGHT_DIRECTIONAL: u32 = 1u;
const LIGHT_SPOT: u32 = 2u;

// How many points of a light with a radius are asked whether they are hidden.
const PENUMBRA_SAMPLES: u32 = 16u;

struct Light {
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
    map_shift: vec2f,
    map_eye: vec3f,
    map_near: f32,
    map_right: vec3f,
    map_far: f32,
    map_up: vec3f,
    // The first of its layers; below 0: it has none.
    map_layer: i32,
}

struct Incoming {
    // Unit vector to the light; 0 if no light arrives.
    direction: vec3f,
    distance: f32,
    color: vec3f,
}

fn light_incoming(light: Light, point: vec3f) -> Incoming {
    if light.kind == LIGHT_DIRECTIONAL {
        return Incoming(-light.direction, HUGE, light.color);
    }
    let way = light.position - point;
    let distance = length(way);
    // Punctual lights of glTF fall off with the squared distance; the tutorials' do not fall off.
    let falloff = select(1.0, 1.0 / max(distance * distance, 1e-8), REFLECTION_IS_PHYSICAL);
    var incoming = Incoming(normalized_or(way, vec3f(0.0)), distance, light.color * falloff);
    if light.kind == LIGHT_SPOT {
        let cos = -dot(incoming.direction, light.direction);
        let x = clamp((cos - light.cos_outer) / (light.cos_inner - light.cos_outer), 0.0, 1.0);
        incoming.color *= x * x * (3.0 - 2.0 * x);
    }
    return incoming;
}

// The direction to point `i` of PENUMBRA_SAMPLES on the light's disc, on Vogel's spiral (1979).
fn light_sample(light: Light, incoming: Incoming, i: u32, turn: f32) -> vec3f {
    let distance = select(incoming.distance, 1.0, light.kind == LIGHT_DIRECTIONAL);
    return normalized_or(incoming.direction * distance + light_offset(light, incoming, i, turn), vec3f(0.0));
}

// The way from the disc's middle to that point; of a directional light, at distance 1.
fn light_offset(light: Light, incoming: Incoming, i: u32, turn: f32) -> vec3f {
    let r = sqrt((f32(i) + 0.5) / f32(PENUMBRA_SAMPLES)) * light.radius;
    let angle = f32(i) * 2.3999632 + turn;
    return any_orthonormal(incoming.direction) * (cos(angle) * r)
        + any_orthonormal_second(incoming.direction) * (sin(angle) * r);
}

// An angle that differs from pixel to pixel, so that a penumbra shows as fine grain instead of bands (interleaved gradient
// noise, Jimenez 2014).
fn pixel_turn(pixel: vec2f) -> f32 {
    let inner = fract(0.06711056 * pixel.x + 0.00583715 * pixel.y);
    return fract(52.982918 * inner) * 6.2831853;
}
