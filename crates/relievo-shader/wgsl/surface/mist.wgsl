//! Mist as it lies in the scene: rays through it, and the light that arrives in it.
//!
//! Gives relievo_mist, RelievoMistSpan, relievo_mist_span, relievo_mist_transmittance, relievo_mist_ray, relievo_mist_scattered;
//! declares the bindings of group 3.
//! #import scene
//! #import surface
//! #import cast_shadow
//! #import environment
//! #import medium

// MistVolume::MAX_PLANES of relievo-scene.
const RELIEVO_MAX_MIST_PLANES: u32 = 18u;

// MistVolume and Mist of relievo-scene.
struct RelievoMist {
    // A point, with its height and uv.
    origin: vec3f,
    height: f32,
    uv: vec2f,
    plane_count: u32,
    // Points along a ray at which arriving light is looked at.
    steps: u32,
    // Of u, v and height, per scene unit.
    u_gradient: vec3f,
    density: f32,
    v_gradient: vec3f,
    softness: f32,
    height_gradient: vec3f,
    anisotropy: f32,
    albedo: vec3f,
    // Not 0: light in it is shadowed.
    is_shadowed: u32,
    // The light whose way to surfaces is looked at.
    light: u32,
    // Inside, xyz · p ≥ w.
    planes: array<vec4f, RELIEVO_MAX_MIST_PLANES>,
}

@group(3) @binding(0) var<uniform> relievo_mist: RelievoMist;
// What lies behind the mist, as depth passes draw it.
@group(3) @binding(1) var relievo_scene_depth: texture_2d<f32>;

// The part of a ray that lies in the mist.
struct RelievoMistSpan {
    start: f32,
    length: f32,
    // By distance from the start.
    line: RelievoHeightLine,
    is_open: bool,
}

fn relievo_mist_span(origin: vec3f, direction: vec3f, near: f32, far: f32) -> RelievoMistSpan {
    var start = near;
    var end = far;
    var outside = false;
    for (var i = 0u; i < min(relievo_mist.plane_count, RELIEVO_MAX_MIST_PLANES); i++) {
        let plane = relievo_mist.planes[i];
        let beyond = dot(plane.xyz, origin) - plane.w;
        let rate = dot(plane.xyz, direction);
        if rate > 0.0 {
            start = max(start, -beyond / rate);
        } else if rate < 0.0 {
            end = min(end, -beyond / rate);
        } else {
            outside = outside || beyond < 0.0;
        }
    }
    let offset = origin + direction * start - relievo_mist.origin;
    let line = RelievoHeightLine(
        relievo_mist.uv + vec2f(dot(relievo_mist.u_gradient, offset), dot(relievo_mist.v_gradient, offset)),
        vec2f(dot(relievo_mist.u_gradient, direction), dot(relievo_mist.v_gradient, direction)),
        relievo_mist.height + dot(relievo_mist.height_gradient, offset),
        dot(relievo_mist.height_gradient, direction));
    return RelievoMistSpan(start, end - start, line, !outside && start < end && end < RELIEVO_FAR_LIGHT);
}

fn relievo_mist_medium() -> RelievoMedium {
    return RelievoMedium(relievo_mist.density, relievo_mist.softness);
}

// How much light passes between a point and another in a direction.
fn relievo_mist_transmittance(point: vec3f, direction: vec3f, distance: f32) -> f32 {
    let span = relievo_mist_span(point, direction, 0.0, distance);
    if !span.is_open {
        return 1.0;
    }
    return relievo_transmittance(relievo_optical_depth(relievo_surface_level(0.0), span.line, span.length, relievo_mist_medium()));
}

// The ray through a pixel, and the distance of the surface that it ends at.
struct RelievoMistRay {
    origin: vec3f,
    direction: vec3f,
    near: f32,
    end: f32,
    // Not so where nothing but the surroundings is seen.
    ends_at_surface: bool,
}

fn relievo_mist_ray(pixel: vec2f) -> RelievoMistRay {
    let size = vec2f(textureDimensions(relievo_scene_depth));
    let side = (pixel / size * 2.0 - 1.0) * vec2f(1.0, -1.0) - relievo_view.jitter;
    let offset = relievo_view.right * (side.x / dot(relievo_view.right, relievo_view.right))
        + relievo_view.up * (side.y / dot(relievo_view.up, relievo_view.up));
    let parallel = relievo_view.parallel != 0u;
    let direction = normalize(relievo_view.forward + select(offset, vec3f(0.0), parallel));
    let along = dot(direction, relievo_view.forward);
    let depth = textureLoad(relievo_scene_depth, vec2i(pixel), 0).r;
    let view_depth = select(relievo_view.near / max(depth, 1e-30), (1.0 - depth) * relievo_view.far, parallel);
    return RelievoMistRay(
        relievo_view.eye + select(vec3f(0.0), offset, parallel), direction, relievo_view.near / along,
        select(RELIEVO_HUGE, view_depth / along, depth > 0.0), depth > 0.0);
}

// The share of a light that reaches a point of the mist, through the mist itself and past every surface.
fn relievo_mist_light_factor(light: RelievoLight, point: vec3f, incoming: RelievoIncomingLight) -> f32 {
    if relievo_mist.is_shadowed == 0u {
        return 1.0;
    }
    let through = relievo_mist_transmittance(point, incoming.direction, incoming.distance);
    if through <= 0.0 {
        return 0.0;
    }
    return through * relievo_cast_shadow(light, RelievoShadowReceiver(point, incoming.direction, point, 0u), point);
}

// The light that arrives at a point, as far as it is scattered against `direction`.
fn relievo_mist_scattered(point: vec3f, direction: vec3f) -> vec3f {
    var sum = vec3f(relievo_view.ambient);
    if RELIEVO_ENVIRONMENT_IS_SEEN {
        sum += relievo_environment_received(relievo_normalized_or(relievo_mist.height_gradient, vec3f(0.0)));
    }
    // Blinn-Phong's lights leave out the π that a matt surface divides by.
    let unit = select(3.14159265, 1.0, RELIEVO_REFLECTION_IS_PHYSICAL);
    for (var i = 0u; i < min(relievo_view.light_count, RELIEVO_MAX_LIGHTS); i++) {
        let light = relievo_lights[i];
        let incoming = relievo_light_incoming(light, point);
        if all(incoming.direction == vec3f(0.0)) || all(incoming.color == vec3f(0.0)) {
            continue;
        }
        let factor = relievo_mist_light_factor(light, point, incoming);
        let phase = relievo_henyey_greenstein(dot(incoming.direction, direction), relievo_mist.anisotropy);
        sum += incoming.color * (factor * unit * phase);
    }
    return sum;
}
