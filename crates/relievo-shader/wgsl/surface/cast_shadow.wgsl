//! Shadows of objects on each other, and of displaced geometry on itself: looked up in what the lights see first.
//!
//! Gives RelievoShadowReceiver, relievo_receiver_at, relievo_cast_shadow, relievo_is_cast_soft_shadow; declares the
//! bindings of the shadow maps, group 0.
//! #import visible
//! #import light
//! #import casters
//! #import chosen_drawing

// How much of a texel a shadow's border is spread over: just enough to have no stairs.
const RELIEVO_SHADOW_BORDER: f32 = 0.25;
// How far before a surface a caster must lie, in texels of the map, and as a fraction of the distance.
const RELIEVO_MARGIN_TEXELS: f32 = 0.5;
// The same for facets of displaced geometry among each other.
const RELIEVO_MARGIN_FACETS: f32 = 2.0;
const RELIEVO_MARGIN_DISTANCE: f32 = 2e-5;
// The steepest plane that is continued to the middle of a texel, as a tangent.
const RELIEVO_STEEPEST_PLANE: f32 = 64.0;
const RELIEVO_NO_BLOCKER: f32 = -1.0;
// At how many distances, each half the one before, a soft shadow's caster is looked for.
const RELIEVO_PENUMBRA_STEPS: u32 = 5u;

@group(0) @binding(2) var relievo_shadow_depths: texture_2d_array<f32>;
@group(0) @binding(3) var relievo_shadow_objects: texture_2d_array<u32>;

// A point that may lie in shadow.
struct RelievoShadowReceiver {
    position: vec3f,
    // The polygon's, of unit length.
    normal: vec3f,
    // The point of the lid above it: nothing of its own relief lies beyond. What is nearer to the light is another part.
    lid: vec3f,
    object: u32,
}

// One view of a light, as in View.
struct RelievoShadowView {
    eye: vec3f,
    near: f32,
    right: vec3f,
    far: f32,
    up: vec3f,
    layer: i32,
    forward: vec3f,
    window_offset: vec2f,
    parallel: bool,
}

fn relievo_receiver_at(point: RelievoVisiblePoint, front: bool) -> RelievoShadowReceiver {
    var normal = relievo_normalized_or(point.polygon, point.at.frame[2]);
    let faces_eye = dot(normal, point.to_eye) >= 0.0;
    normal = select(-normal, normal, faces_eye == front);
    var lid = point.position;
    if RELIEVO_TECHNIQUE_MARCHES && RELIEVO_WRITES_DEPTH {
        lid += point.at.frame[2] * (point.record.depth * point.at.depth);
    }
    var position = point.position;
    if RELIEVO_IS_DISPLACED {
        // Geometry that is seen from behind is lit from there.
        let side = select(-1.0, 1.0, front);
        normal *= side;
        // Above the terraces of an 8-bit map, which would throw shadows on each other.
        position += point.at.frame[2] * (side * point.at.depth * relievo_surface.height_step);
        lid = position;
    }
    return RelievoShadowReceiver(position, normal, lid, relievo_object.number);
}

// The view in which a light sees a point: of a point light the face of the cube around it.
fn relievo_shadow_view(light: RelievoLight, point: vec3f) -> RelievoShadowView {
    let parallel = light.kind == RELIEVO_LIGHT_DIRECTIONAL;
    if dot(light.map_right, light.map_right) > 0.0 {
        return RelievoShadowView(
            light.map_eye, light.map_near, light.map_right, light.map_far, light.map_up, light.map_layer,
            light.direction, light.map_window_offset, parallel);
    }
    let offset = point - light.map_eye;
    let size = abs(offset);
    var axis = 0;
    if size.y > size.x {
        axis = 1;
    }
    if size.z > max(size.x, size.y) {
        axis = 2;
    }
    let negative = offset[axis] < 0.0;
    var forward = vec3f(0.0);
    forward[axis] = select(1.0, -1.0, negative);
    let up = select(vec3f(0.0, 1.0, 0.0), vec3f(0.0, 0.0, 1.0), axis == 1);
    return RelievoShadowView(
        light.map_eye, light.map_near, cross(forward, up), light.map_far, up,
        light.map_layer + axis * 2 + select(0, 1, negative), forward, vec2f(0.0), false);
}

// Where a view sees a point: halves of its picture from the middle, right and up, and the distance along its axis.
fn relievo_shadow_project(map: RelievoShadowView, point: vec3f) -> vec3f {
    let offset = point - map.eye;
    let view_depth = dot(offset, map.forward);
    let side = vec2f(dot(offset, map.right), dot(offset, map.up));
    return vec3f(select(side / view_depth, side, map.parallel) + map.window_offset, view_depth);
}

// How far along the axis the ray through a place meets the plane through `point`.
fn relievo_plane_depth(map: RelievoShadowView, ndc: vec2f, point: vec3f, normal: vec3f) -> f32 {
    let offset = ndc - map.window_offset;
    let side = map.right * (offset.x / dot(map.right, map.right)) + map.up * (offset.y / dot(map.up, map.up));
    if map.parallel {
        return dot(point - map.eye - side, normal) / dot(map.forward, normal);
    }
    return dot(point - map.eye, normal) / dot(map.forward + side, normal);
}

// The distance along the axis of what a texel shows, and whether it counts as a caster before the receiver.
struct RelievoShadowTap {
    view_depth: f32,
    blocks: bool,
}

fn relievo_shadow_tap(
    map: RelievoShadowView, receiver: RelievoShadowReceiver, texel: vec2i, size: vec2f, view_depth: f32,
) -> RelievoShadowTap {
    let last = vec2i(size) - 1;
    let at = clamp(texel, vec2i(0), last);
    let depth = textureLoad(relievo_shadow_depths, at, map.layer, 0).r;
    let number = textureLoad(relievo_shadow_objects, at, map.layer, 0).r;
    let own = number == receiver.object;
    // A facet of a marched mesh may face away from a light that its smooth normals face: the mesh before it is its own.
    let from_light = select(receiver.position - map.eye, map.forward, map.parallel);
    let away = RELIEVO_TECHNIQUE_MARCHES && dot(receiver.normal, from_light) > 0.0;
    if depth <= 0.0 || (RELIEVO_CASTERS == RELIEVO_CASTERS_ITSELF && !own) || (own && away) {
        return RelievoShadowTap(0.0, false);
    }
    let seen = select(map.near / depth, (1.0 - depth) * map.far, map.parallel);
    let ndc = ((vec2f(at) + 0.5) / size * 2.0 - 1.0) * vec2f(1.0, -1.0);
    let point = select(receiver.position, receiver.lid, own);
    let texel_size = 2.0 / (size.x * length(map.right)) * select(view_depth, 1.0, map.parallel);
    let middle = dot(point - map.eye, map.forward);
    let plane = relievo_plane_depth(map, ndc, point, receiver.normal);
    // The lid is left where the plane says, however slantwise. Written so that a number that is none is left out too.
    let near_enough = (own && RELIEVO_TECHNIQUE_MARCHES) || abs(plane - middle) <= RELIEVO_STEEPEST_PLANE * texel_size;
    let margin =
        texel_size * select(RELIEVO_MARGIN_TEXELS, RELIEVO_MARGIN_FACETS, own && RELIEVO_IS_DISPLACED) + view_depth * RELIEVO_MARGIN_DISTANCE;
    let limit = select(middle, plane, near_enough) - margin;
    return RelievoShadowTap(seen, seen < limit);
}

// A facet that faces away from the light is its own shadow, as it is where the relief is marched.
fn relievo_facet_is_lit(light: RelievoLight, receiver: RelievoShadowReceiver) -> bool {
    let from_light = select(receiver.position - light.position, light.direction, light.kind == RELIEVO_LIGHT_DIRECTIONAL);
    return !RELIEVO_IS_DISPLACED || relievo_surface.height_step > 0.0 || dot(receiver.normal, from_light) < 0.0;
}

// A place in a light's maps.
struct RelievoShadowTexel {
    map: RelievoShadowView,
    size: vec2f,
    // In texels from the upper left corner, and the distance along the axis.
    texel: vec2f,
    view_depth: f32,
    // Beyond the map there are no casters.
    inside: bool,
}

fn relievo_shadow_texel(light: RelievoLight, at: vec3f) -> RelievoShadowTexel {
    let map = relievo_shadow_view(light, at);
    let ndc = relievo_shadow_project(map, at);
    let size = vec2f(textureDimensions(relievo_shadow_depths));
    let texel = (ndc.xy * vec2f(0.5, -0.5) + 0.5) * size;
    let inside = texel.x >= 0.0 && texel.y >= 0.0 && texel.x <= size.x && texel.y <= size.y;
    return RelievoShadowTexel(map, size, texel, ndc.z, light.map_layer >= 0 && inside && (map.parallel || ndc.z > 0.0));
}

// How much of a light gets past all casters on its way to the receiver, as its map shows them towards `at`.
fn relievo_cast_shadow(light: RelievoLight, receiver: RelievoShadowReceiver, at: vec3f) -> f32 {
    let point = relievo_shadow_texel(light, at);
    var share = 1.0;
    if point.inside {
        let corner = floor(point.texel - 0.5);
        let f = point.texel - 0.5 - corner;
        var lit = vec4f(1.0);
        for (var k = 0u; k < 4u; k++) {
            let texel = vec2i(corner) + vec2i(i32(k & 1u), i32(k >> 1u));
            if relievo_shadow_tap(point.map, receiver, texel, point.size, point.view_depth).blocks {
                lit[k] = 0.0;
            }
        }
        share = mix(mix(lit[0], lit[1], f.x), mix(lit[2], lit[3], f.x), f.y);
    }
    return select(0.0, clamp((share - 0.5) / RELIEVO_SHADOW_BORDER + 0.5, 0.0, 1.0), relievo_facet_is_lit(light, receiver));
}

// How far a ray that ends at a point of a light's disc has gone aside where it meets the caster that the map shows towards
// `at`, as a fraction of the way from the disc's middle to that point; RELIEVO_NO_BLOCKER if it shows none.
fn relievo_blocker_towards(light: RelievoLight, receiver: RelievoShadowReceiver, at: vec3f) -> f32 {
    let point = relievo_shadow_texel(light, at);
    if !point.inside {
        return RELIEVO_NO_BLOCKER;
    }
    let tap = relievo_shadow_tap(point.map, receiver, vec2i(floor(point.texel)), point.size, point.view_depth);
    let gap = max(point.view_depth - tap.view_depth, 0.0);
    return select(RELIEVO_NO_BLOCKER, select(gap / max(tap.view_depth, 1e-6), gap, point.map.parallel), tap.blocks);
}

// Whether one point of a light's disc, `offset` from its middle, is hidden by a caster: the ray to it is followed through the
// map that was drawn from the middle.
fn relievo_is_cast_soft_shadow(light: RelievoLight, receiver: RelievoShadowReceiver, offset: vec3f) -> bool {
    var hidden = false;
    // Casters are looked for up to half way to the light.
    let view_depth = relievo_shadow_texel(light, receiver.position).view_depth;
    var share = select(1.0, 0.5 * view_depth, light.kind == RELIEVO_LIGHT_DIRECTIONAL);
    for (var step = 0u; step < RELIEVO_PENUMBRA_STEPS && !hidden; step++) {
        // What is seen beside the ray may be nearer or farther: where that is, the ray has gone aside by another length.
        let beside = relievo_blocker_towards(light, receiver, receiver.position + offset * share);
        if beside != RELIEVO_NO_BLOCKER {
            hidden = relievo_blocker_towards(light, receiver, receiver.position + offset * beside) != RELIEVO_NO_BLOCKER;
        }
        share *= 0.5;
    }
    return hidden || !relievo_facet_is_lit(light, receiver);
}
