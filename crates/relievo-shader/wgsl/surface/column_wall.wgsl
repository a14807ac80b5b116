//! The wall between two columns of a nearest map that a hit lies on: names and meaning are those of the crate relievo-march.
//!
//! Gives RelievoColumnWall, relievo_column_wall.
//! Needs what height.wgsl needs.
//! #import height

// The largest distance of a hit from its wall, in texels.
const RELIEVO_WALL_REACH: f32 = 0.0625;
// The distance in height within which a hit lies on a column's top, and that by which the march may go on down a wall.
const RELIEVO_WALL_TOP: f32 = 1e-4;
const RELIEVO_WALL_DEEPER: f32 = 2e-3;
// How far beside a wall rays leave it, in texels.
const RELIEVO_WALL_BESIDE: f32 = 0.00390625;

struct RelievoColumnWall {
    // From the higher column to the lower one: 1 or −1 along u or along v; 0 where there is no wall.
    outward: vec2f,
    // A hair beyond the wall, over the lower column; where there is no wall the uv that was asked for.
    beside: vec2f,
}

fn relievo_column_wall(field: RelievoHeightField, uv: vec2f, depth: f32) -> RelievoColumnWall {
    var wall = RelievoColumnWall(vec2f(0.0), uv);
    if !RELIEVO_NEAREST {
        return wall;
    }
    let size = vec2f(field.size);
    let x = uv * size;
    let cell = vec2i(floor(x));
    let height = 1.0 - depth;
    var nearest = RELIEVO_WALL_REACH;
    for (var k = 0u; k < 2u; k++) {
        // As Rust rounds: halves away from 0; they are out of reach.
        let edge = floor(x[k] + 0.5);
        let distance = abs(x[k] - edge);
        if distance > nearest {
            continue;
        }
        let at = i32(edge);
        let before = relievo_height_corners(field, select(vec2i(cell.x, at - 1), vec2i(at - 1, cell.y), k == 0u))[0];
        let after = relievo_height_corners(field, select(vec2i(cell.x, at), vec2i(at, cell.y), k == 0u))[0];
        // The march goes a hair into a wall, maybe deeper than its foot.
        let foot = min(before, after) + select(RELIEVO_WALL_TOP, -RELIEVO_WALL_DEEPER, (x[k] < edge) == (before > after));
        if !(height > foot && height < max(before, after) - RELIEVO_WALL_TOP) {
            continue;
        }
        nearest = distance;
        let outward = select(-1.0, 1.0, before > after);
        let beside = (edge + outward * max(RELIEVO_WALL_BESIDE, abs(edge) * 4.76837158e-7)) / size[k];
        wall = RelievoColumnWall(select(vec2f(0.0, outward), vec2f(outward, 0.0), k == 0u), select(vec2f(uv.x, beside), vec2f(beside, uv.y), k == 0u));
    }
    return wall;
}
