//! Shadows of objects on each other, and of displaced geometry on itself: looked up in what the lights see first.
//!
//! Gives Receiver, receiver_at, cast_shadow, is_cast_soft_shadow; declares the bindings of the shadow maps, group 0.
//! #import visible
//! #import light
//! #import casters
//! #import chosen_drawing

// How much of a texel a shadow's border is spread over: just enough to have no stairs.
const BORDER: f32 = 0.25;
// How far before a surface a caster must lie, in texels of the map, and as a fraction of the distance.
const MARGIN_TEXELS: f32 = 0.5;
// The same for facets of displaced geometry among each other.
const MARGIN_FACETS: f32 = 2.0;
const MARGIN_DISTANCE: f32 = 2e-5;
// The steepest plane that is continued to the middle of a texel, as a tangent.
const STEEPEST: f32 = 64.0;
const NO_BLOCKER: f32 = -1.0;
// At how many distances, each half the one before, a soft shadow's caster is looked for.
const PENUMBRA_STEPS: u32 = 5u;

@group(0) @binding(2) var shadow_depths: texture_2d_array<f32>;
@group(0) @binding(3) var shadow_objects: texture_2d_array<u32>;

// A point that may lie in shadow.
struct Receiver {
    position: vec3f,
    // The polygon's, of unit length.
    normal: vec3f,
    // The point of the lid above it: nothing of its own relief lies beyond. What is nearer to the light is another part.
    lid: vec3f,
    object: u32,
}

// One view of a light, as in View.
struct MapView {
    eye: vec3f,
    near: f32,
    right: vec3f,
    far: f32,
    up: vec3f,
    layer: i32,
    forward: vec3f,
    shift: vec2f,
    parallel: bool,
}

fn receiver_at(point: Visible, front: bool) -> Receiver {
    var normal = normalized_or(point.polygon, point.at.frame[2]);
    let faces_eye = dot(normal, point.toward) >= 0.0;
    normal = select(-normal, normal, faces_eye == front);
    var lid = point.position;
    if TECHNIQUE_MARCHES && WRITES_DEPTH {
        lid += point.at.frame[2] * (point.record.depth * point.at.depth);
    }
    var position = point.position;
    if IS_DISPLACED {
        // Above the terraces of an 8-bit map, which would throw shadows on each other.
        position += point.at.frame[2] * (point.at.depth * surface.height_step);
        lid = position;
    }
    return Receiver(position, normal, lid, object.number);
}

// The view in which a light sees a point: of a point light the face of the cube around it.
fn map_view(light: Light, point: vec3f) -> MapView {
    let parallel = light.kind == LIGHT_DIRECTIONAL;
    if dot(light.map_right, light.map_right) > 0.0 {
        return MapView(
            light.map_eye, light.map_near, light.map_right, light.map_far, light.map_up, light.map_layer,
            light.direction, light.map_shift, parallel);
    }
    let way = point - light.map_eye;
    let size = abs(way);
    var axis = 0;
    if size.y > size.x {
        axis = 1;
    }
    if size.z > max(size.x, size.y) {
        axis = 2;
    }
    let negative = way[axis] < 0.0;
    var forward = vec3f(0.0);
    forward[axis] = select(1.0, -1.0, negative);
    let up = select(vec3f(0.0, 1.0, 0.0), vec3f(0.0, 0.0, 1.0), axis == 1);
    return MapView(
        light.map_eye, light.map_near, cross(forward, up), light.map_far, up,
        light.map_layer + axis * 2 + select(0, 1, negative), forward, vec2f(0.0), false);
}

// Where a view sees a point: halves of its picture from the middle, right and up, and the distance along its axis.
fn map_place(map: MapView, point: vec3f) -> vec3f {
    let way = point - map.eye;
    let ahead = dot(way, map.forward);
    let side = vec2f(dot(way, map.right), dot(way, map.up));
    return vec3f(select(side / ahead, side, map.parallel) + map.shift, ahead);
}

// How far along the axis the ray through a place meets the plane through `point`.
fn plane_ahead(map: MapView, place: vec2f, point: vec3f, normal: vec3f) -> f32 {
    let offset = place - map.shift;
    let side = map.right * (offset.x / dot(map.right, map.right)) + map.up * (offset.y / dot(map.up, map.up));
    if map.parallel {
        return dot(point - map.eye - side, normal) / dot(map.forward, normal);
    }
    return dot(point - map.eye, normal) / dot(map.forward + side, normal);
}

// The distance along the axis of what a texel shows, and whether it counts as a caster before the receiver.
struct Tap {
    ahead: f32,
    blocks: bool,
}

fn map_tap(map: MapView, receiver: Receiver, texel: vec2i, size: vec2f, ahead: f32) -> Tap {
    let last = vec2i(size) - 1;
    let at = clamp(texel, vec2i(0), last);
    let depth = textureLoad(shadow_depths, at, map.layer, 0).r;
    let number = textureLoad(shadow_objects, at, map.layer, 0).r;
    let own = number == receiver.object;
    // A facet of a marched mesh may face away from a light that its smooth normals face: the mesh before it is its own.
    let from_light = select(receiver.position - map.eye, map.forward, map.parallel);
    let away = TECHNIQUE_MARCHES && dot(receiver.normal, from_light) > 0.0;
    if depth <= 0.0 || (CASTERS == CASTERS_ITSELF && !own) || (own && away) {
        return Tap(0.0, false);
    }
    let seen = select(map.near / depth, (1.0 - depth) * map.far, map.parallel);
    let place = ((vec2f(at) + 0.5) / size * 2.0 - 1.0) * vec2f(1.0, -1.0);
    let point = select(receiver.position, receiver.lid, own);
    let pace = 2.0 / (size.x * length(map.right)) * select(ahead, 1.0, map.parallel);
    let middle = dot(point - map.eye, map.forward);
    let plane = plane_ahead(map, place, point, receiver.normal);
    // The lid is left where the plane says, however slantwise. Written so that a number that is none is left out too.
    let near_enough = (own && TECHNIQUE_MARCHES) || abs(plane - middle) <= STEEPEST * pace;
    let margin = pace * select(MARGIN_TEXELS, MARGIN_FACETS, own && IS_DISPLACED) + ahead * MARGIN_DISTANCE;
    let limit = select(middle, plane, near_enough) - margin;
    return Tap(seen, seen < limit);
}

// A facet that faces away from the light is its own shadow, as it is where the relief is marched.
fn facet_is_lit(light: Light, receiver: Receiver) -> bool {
    let from_light = select(receiver.position - light.position, light.direction, light.kind == LIGHT_DIRECTIONAL);
    return !IS_DISPLACED || surface.height_step > 0.0 || dot(receiver.normal, from_light) < 0.0;
}

// A place in a light's maps.
struct MapPoint {
    map: MapView,
    size: vec2f,
    // In texels from the upper left corner, and the distance along the axis.
    texel: vec2f,
    ahead: f32,
    // Beyond the map there are no casters.
    inside: bool,
}

fn map_point(light: Light, at: vec3f) -> MapPoint {
    let map = map_view(light, at);
    let place = map_place(map, at);
    let size = vec2f(textureDimensions(shadow_depths));
    let texel = (place.xy * vec2f(0.5, -0.5) + 0.5) * size;
    let inside = texel.x >= 0.0 && texel.y >= 0.0 && texel.x <= size.x && texel.y <= size.y;
    return MapPoint(map, size, texel, place.z, light.map_layer >= 0 && inside && (map.parallel || place.z > 0.0));
}

// How much of a light gets past all casters on its way to the receiver, as its map shows them towards `at`.
fn cast_shadow(light: Light, receiver: Receiver, at: vec3f) -> f32 {
    let point = map_point(light, at);
    var share = 1.0;
    if point.inside {
        let corner = floor(point.texel - 0.5);
        let f = point.texel - 0.5 - corner;
        var lit = vec4f(1.0);
        for (var k = 0u; k < 4u; k++) {
            let texel = vec2i(corner) + vec2i(i32(k & 1u), i32(k >> 1u));
            if map_tap(point.map, receiver, texel, point.size, point.ahead).blocks {
                lit[k] = 0.0;
            }
        }
        share = mix(mix(lit[0], lit[1], f.x), mix(lit[2], lit[3], f.x), f.y);
    }
    return select(0.0, clamp((share - 0.5) / BORDER + 0.5, 0.0, 1.0), facet_is_lit(light, receiver));
}

// How far a ray that ends at a point of a light's disc has gone aside where it meets the caster that the map shows towards
// `at`, as a fraction of the way from the disc's middle to that point; NO_BLOCKER if it shows none.
fn blocker_towards(light: Light, receiver: Receiver, at: vec3f) -> f32 {
    let point = map_point(light, at);
    if !point.inside {
        return NO_BLOCKER;
    }
    let tap = map_tap(point.map, receiver, vec2i(floor(point.texel)), point.size, point.ahead);
    let gap = max(point.ahead - tap.ahead, 0.0);
    return select(NO_BLOCKER, select(gap / max(tap.ahead, 1e-6), gap, point.map.parallel), tap.blocks);
}

// Whether one point of a light's disc, `offset` from its middle, is hidden by a caster: the ray to it is followed through the
// map that was drawn from the middle.
fn is_cast_soft_shadow(light: Light, receiver: Receiver, offset: vec3f) -> bool {
    var hidden = false;
    // Casters are looked for up to half way to the light.
    let ahead = map_point(light, receiver.position).ahead;
    var share = select(1.0, 0.5 * ahead, light.kind == LIGHT_DIRECTIONAL);
    for (var step = 0u; step < PENUMBRA_STEPS && !hidden; step++) {
        // What is seen beside the ray may be nearer or farther: where that is, the ray has gone aside by another length.
        let beside = blocker_towards(light, receiver, receiver.position + offset * share);
        if beside != NO_BLOCKER {
            hidden = blocker_towards(light, receiver, receiver.position + offset * beside) != NO_BLOCKER;
        }
        share *= 0.5;
    }
    return hidden || !facet_is_lit(light, receiver);
}
