//! The vertex stage of reliefs in shells: an instance is a triangle, its 24 vertices are the hull around the shell over it.
//!
//! Gives the entry point `relievo_vertex`, RelievoVertexOut.
//! Needs nothing else.
//! #import scene

// Positions, normals and tangents of the corners, in scene space; texture coordinates beside: u with positions, v with normals.
struct RelievoVertexIn {
    @location(0) position_a: vec4f,
    @location(1) position_b: vec4f,
    @location(2) position_c: vec4f,
    @location(3) normal_a: vec4f,
    @location(4) normal_b: vec4f,
    @location(5) normal_c: vec4f,
    @location(6) tangent_a: vec4f,
    @location(7) tangent_b: vec4f,
    @location(8) tangent_c: vec4f,
    // The hull's lowest and highest offset along the normals, which diagonals of its walls fold outwards (bits), the length of
    // a texture repeat.
    @location(9) hull: vec4f,
    // Along which the relief rises.
    @location(10) direction_a: vec3f,
    @location(11) direction_b: vec3f,
    @location(12) direction_c: vec3f,
}

struct RelievoVertexOut {
    @invariant @builtin(position) clip: vec4f,
    // On the far side of the hull.
    @location(0) @interpolate(perspective, centroid) position: vec3f,
    @location(1) @interpolate(flat) position_a: vec4f,
    @location(2) @interpolate(flat) position_b: vec4f,
    @location(3) @interpolate(flat) position_c: vec4f,
    @location(4) @interpolate(flat) normal_a: vec4f,
    @location(5) @interpolate(flat) normal_b: vec4f,
    @location(6) @interpolate(flat) normal_c: vec4f,
    @location(7) @interpolate(flat) tangent_a: vec4f,
    @location(8) @interpolate(flat) tangent_b: vec4f,
    @location(9) @interpolate(flat) tangent_c: vec4f,
    @location(10) @interpolate(flat) hull: vec4f,
    @location(11) @interpolate(flat) direction_a: vec3f,
    @location(12) @interpolate(flat) direction_b: vec3f,
    @location(13) @interpolate(flat) direction_c: vec3f,
}

// The corner (0, 1, 2) and side (0 = floor, 1 = lid) of a vertex of the hull: lid, floor, and two triangles for each wall.
fn relievo_hull_corner(index: u32, diagonals: u32) -> vec2u {
    let triangle = index / 3u;
    let place = index % 3u;
    if triangle == 0u {
        return vec2u(place, 1u);
    }
    if triangle == 1u {
        return vec2u((3u - place) % 3u, 0u);
    }
    let wall = (triangle - 2u) / 2u;
    let second = (triangle - 2u) % 2u;
    let i = wall;
    let j = (wall + 1u) % 3u;
    // Around the wall, seen from outside: floor i, floor j, lid j, lid i.
    var around = place;
    if ((diagonals >> wall) & 1u) == 0u {
        // From floor i to lid j.
        around = select(place, select(place + 1u, 0u, place == 0u), second == 1u);
    } else {
        // From floor j to lid i.
        around = select(select(place, 3u, place == 2u), place + 1u, second == 1u);
    }
    return vec2u(select(i, j, around == 1u || around == 2u), select(0u, 1u, around >= 2u));
}

@vertex
fn relievo_vertex(in: RelievoVertexIn, @builtin(vertex_index) index: u32) -> RelievoVertexOut {
    let corner = relievo_hull_corner(index, u32(in.hull.z));
    let offset = select(in.hull.x, in.hull.y, corner.y == 1u);
    let position = select(select(in.position_a, in.position_b, corner.x == 1u), in.position_c, corner.x == 2u).xyz;
    let direction = select(select(in.direction_a, in.direction_b, corner.x == 1u), in.direction_c, corner.x == 2u);
    let point = position + direction * offset;
    return RelievoVertexOut(
        relievo_clip_position(point), point, in.position_a, in.position_b, in.position_c, in.normal_a, in.normal_b, in.normal_c,
        in.tangent_a, in.tangent_b, in.tangent_c, in.hull, in.direction_a, in.direction_b, in.direction_c);
}
