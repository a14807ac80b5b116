//! The vertex stage of reliefs in shells: an instance is a triangle, its vertices are those of the hull around the shell over it.
//!
//! Gives the entry point `relievo_vertex`, RelievoVertexOut.
//! Needs nothing else.
//! #import scene
//! #import shells
//! #import chosen_shells

struct RelievoVertexIn {
    // Its place in the texture of shells.
    @location(0) triangle: u32,
    // The lowest and highest offset along the normals.
    @location(1) floor: f32,
    @location(2) lid: f32,
    // Which diagonals of the walls are folded the other way, and from bit 3 on which edges have no neighbor.
    @location(3) walls: u32,
}

// The face that is not a wall.
const RELIEVO_LID: u32 = 3u;

struct RelievoVertexOut {
    @invariant @builtin(position) clip: vec4f,
    @location(0) @interpolate(perspective, centroid) position: vec3f,
    @location(1) @interpolate(flat) triangle: u32,
    @location(2) @interpolate(flat) limits: vec2f,
    // The wall, by the corner opposite to it, or RELIEVO_LID.
    @location(3) @interpolate(flat) face: u32,
}

// The corner (0, 1, 2), the side (0 = floor, 1 = lid) and the face of a vertex of the hull: lid, two triangles for each wall, floor.
fn relievo_hull_corner(index: u32, diagonals: u32) -> vec3u {
    let triangle = index / 3u;
    let place = index % 3u;
    if triangle == 0u {
        return vec3u(place, 1u, RELIEVO_LID);
    }
    if triangle == 7u {
        return vec3u((3u - place) % 3u, 0u, RELIEVO_LID);
    }
    let wall = (triangle - 1u) / 2u;
    let second = (triangle - 1u) % 2u;
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
    return vec3u(select(i, j, around == 1u || around == 2u), select(0u, 1u, around >= 2u), (wall + 2u) % 3u);
}

@vertex
fn relievo_vertex(in: RelievoVertexIn, @builtin(vertex_index) index: u32) -> RelievoVertexOut {
    let corner = relievo_hull_corner(index, in.walls);
    let texel = relievo_shell_texel(in.triangle);
    let k = i32(corner.x);
    var offset = select(in.floor, in.lid, corner.y == 1u);
    if corner.z != RELIEVO_LID && RELIEVO_SHELLS_ARE_WALKED && ((in.walls >> (3u + corner.z)) & 1u) == 0u {
        // Rays come through this wall from the neighbor: it has no height.
        offset = in.lid;
    }
    let point = relievo_shell_load(texel, k).xyz + relievo_shell_load(texel, k + 3).xyz * offset;
    return RelievoVertexOut(relievo_clip_position(point), point, in.triangle, vec2f(in.floor, in.lid), corner.z);
}
