//! The exact march through the max pyramid: the same cells with the same borders as walk.wgsl, but for those in blocks that
//! the line passes above. The same steps as relievo-march/src/descent.rs, so that hits and costs agree.
//!
//! Gives first_crossing.
//! Needs what height.wgsl needs, and a global `relief_pyramid: texture_2d<u32>` (see HeightTexture): the header of mip level
//! l is texel (l, 0): row of the lowest nodes and, from bit 24 on, number of levels; then as f32 the height of code 0, the
//! height of one code more, and how far blocks lie below the top. A node is the highest codes of 4×4 blocks, a row to a
//! channel, the first in the lowest byte; the rows of each level follow those of the one below.
//! #import record
//! #import height
//! #import walk

// The longest march, as long as the plain walk's: a turn goes a cell further or more, or a level down after one that did.
const MAX_TURNS: u32 = MAX_CELLS;
// How far above a block's code a line must be to pass over it: covers the rounding of codes and lines.
const CODE_SLACK: f32 = 0.00390625;
// How far rounding may put a point beside its cell, in texels.
const POINT_SLACK: f32 = 0.015625;
// A block that goes on for ever.
const NEVER: i32 = 1 << 30u;

// Where a line is: in the endless grid of cells, counted from the one it starts in, and in the map.
struct Place {
    cell: vec2i,
    index: vec2i,
    // -1 where the map stands mirrored.
    facing: vec2i,
}

// The first s in [start, end] at which the line is on or below the surface.
fn first_crossing(field: Field, line: Line, start: f32, end: f32) -> Walk {
    // Known before, where it is not so: adapters in software go through both branches.
    if FIELD_STRETCHES && field.stretch.x > 0 {
        // Its border is not the map's.
        return walk_to_crossing(field, line, start, end, MAX_CELLS);
    }
    return descend(field, line, start, end);
}

// The same place, `cells` further along both axes; at most the first one beyond the block.
fn advanced(place: Place, step: vec2i, cells: vec2i, size: vec2i) -> Place {
    let index = place.index + step * place.facing * cells;
    let x = height_beyond(index.x, place.facing.x, size.x);
    let y = height_beyond(index.y, place.facing.y, size.y);
    return Place(place.cell + step * cells, vec2i(x[0], y[0]), vec2i(x[1], y[1]));
}

// The texels on both sides of a cell, in the order in which the endless row has them.
fn sides(index: i32, facing: i32, n: i32) -> vec2i {
    let first = clamp(index, 0, n - 1);
    let second = select(max(index + 1, 0), height_last(n), index >= n - 1);
    return select(vec2i(second, first), vec2i(first, second), facing > 0);
}

fn cell_corners(field: Field, place: Place) -> vec4f {
    let x = sides(place.index.x, place.facing.x, field.size.x);
    let y = sides(place.index.y, place.facing.y, field.size.y);
    return vec4f(
        textureLoad(relief_heights, vec2i(x[0], y[0]), field.level).r,
        textureLoad(relief_heights, vec2i(x[1], y[0]), field.level).r,
        textureLoad(relief_heights, vec2i(x[0], y[1]), field.level).r,
        textureLoad(relief_heights, vec2i(x[1], y[1]), field.level).r,
    );
}

// The node above a node, or the one that has a cell, of a level.
fn looked_up(place: Place, size: vec2i) -> vec2u {
    return vec2u(clamp(place.index, vec2i(0), size - 1));
}

// Rows of nodes of a level.
fn node_rows(size: vec2i, level: u32) -> i32 {
    return (size.y + (1 << (2u * level)) - 1) >> (2u * level);
}

fn load_node(row: i32, at: vec2u) -> vec4u {
    return textureLoad(relief_pyramid, vec2i(at) + vec2i(0, row), 0);
}

// The level at which to begin a march that is likely to go this many texels before it comes near the surface.
fn start_level(texels: f32, top: u32) -> u32 {
    let level = 1u + select(0u, 1u, texels >= 2.0) + select(0u, 1u, texels >= 16.0) + select(0u, 1u, texels >= 128.0);
    return min(level, top);
}

fn descend(field: Field, line: Line, start: f32, end: f32) -> Walk {
    let size = vec2f(field.size);
    let origin = line.uv * size - 0.5;
    let base = floor(origin);
    let first = vec2i(base);
    let local = origin - base;
    let d = line.slope * size;
    let flat = d == vec2f(0.0);
    let pace = 1.0 / select(d, vec2f(1.0), flat);
    let step = select(vec2i(-1), vec2i(1), d > vec2f(0.0));
    let ahead = select(vec2i(0), vec2i(1), d > vec2f(0.0));

    let header = textureLoad(relief_pyramid, vec2i(field.level, 0), 0);
    let top = header.x >> 24u;
    // The line's height in codes, with the slack off.
    let per_step = 1.0 / bitcast<f32>(header.z);
    let slack = CODE_SLACK + 4.0 * 1.1920929e-7 * per_step;
    let code = (line.height - bitcast<f32>(header.y)) * per_step - slack;
    let code_rise = line.rise * per_step;

    var s = start;
    var entry = local + d * s;
    let cell = vec2i(floor(entry));
    let x = height_place(first.x + cell.x, field.size.x);
    let y = height_place(first.y + cell.y, field.size.y);
    var at = Place(cell, vec2i(x[0], y[0]), vec2i(x[1], y[1]));

    // From the lid down there is a way to go; elsewhere the surface is near.
    var level = 1u;
    if line.height + line.rise * start >= field.range.y - 1e-6 {
        level = start_level(bitcast<f32>(header.w) * sqrt(d.x * d.x + d.y * d.y), top);
    }
    // Where the nodes of the level begin.
    var row = i32(header.x & 0xffffffu);
    for (var below = 1u; below < level; below++) {
        row += node_rows(field.size, below);
    }
    var here = looked_up(at, field.size) >> vec2u(2u * level);
    var node = vec4u(0u);
    // Whether the node is still to be loaded.
    var fresh = true;
    // The node above, where it was loaded on the way down.
    var parent = vec4u(0u);
    var has_parent = false;
    var fetches = 0u;
    var turns = 0u;
    // Whether the cell's patch has been looked at, and is not met.
    var passed = false;
    var leave = start;
    var lowest = 1.0;
    // Two loops, one in the other, so that neighbours look for their cells together and then at their patches together.
    for (var looks = 0u; looks < MAX_TURNS; looks++) {
        var found = false;
        while turns < MAX_TURNS || passed {
            if fresh {
                node = load_node(row, here);
                fetches += 1u;
                fresh = false;
            }
            turns += select(1u, 0u, passed);
            let shift = 2u * (level - 1u);
            let child = (looked_up(at, field.size) >> vec2u(shift)) & vec2u(3u);
            let half = select(node.xy, node.zw, child.y > 1u);
            let highest = (select(half.x, half.y, (child.y & 1u) != 0u) >> (8u * child.x)) & 0xffu;
            let cells = vec2i(
                height_leave(at.index.x, step.x * at.facing.x, shift, field.size.x),
                height_leave(at.index.y, step.y * at.facing.y, shift, field.size.y),
            );
            let edge = at.cell + step * (cells - 1) + ahead;
            let next = select((vec2f(edge) - local) * pace, vec2f(HUGE), flat | (cells == vec2i(NEVER)));
            let along_v = next.y < next.x;
            let crossing = select(next.x, next.y, along_v);
            leave = min(max(crossing, s), end);
            lowest = select(s, leave, line.rise < 0.0);
            if code + code_rise * lowest <= f32(highest) && !passed {
                if level == 1u {
                    found = true;
                    break;
                }
                level -= 1u;
                row -= node_rows(field.size, level);
                here = looked_up(at, field.size) >> vec2u(2u * level);
                parent = node;
                has_parent = true;
                fresh = true;
                continue;
            }
            passed = false;
            if leave >= end {
                return Walk(end, false, fetches, turns, true);
            }
            s = leave;
            // The plain walk crosses borders by s, at the same s columns first. The cell across is the one that lies
            // between borders so crossed, this one or the next.
            entry = local + d * s;
            let progress = select(vec2f(at.cell + 1) - entry, entry - vec2f(at.cell), step > vec2i(0)) - POINT_SLACK;
            let whole = min(vec2i(max(progress, vec2f(0.0))), cells - 1);
            let border = (vec2f(at.cell + step * whole + ahead) - local) * pace;
            let crossed = select(
                border.y < crossing && whole.y < cells.y - 1 && !flat.y,
                border.x <= crossing && whole.x < cells.x - 1 && !flat.x,
                along_v);
            let more = select(0, 1, crossed);
            let moved = select(vec2i(cells.x, whole.y + more), vec2i(whole.x + more, cells.y), along_v);
            at = advanced(at, step, moved, field.size);
            // The line crosses this border exactly; rounding must not put it beside.
            let exact = vec2f(at.cell - step + ahead);
            entry = select(vec2f(exact.x, entry.y), vec2f(entry.x, exact.y), along_v);

            let before = here;
            here = looked_up(at, field.size) >> vec2u(2u * level);
            if all(here == before) {
                continue;
            }
            let same_parent = all((before >> vec2u(2u)) == (here >> vec2u(2u)));
            fresh = !(has_parent && same_parent);
            node = select(node, parent, !fresh);
            has_parent = false;
            if (!fresh || !same_parent) && level < top {
                row += node_rows(field.size, level);
                level += 1u;
                here = here >> vec2u(2u);
            }
        }
        if !found {
            break;
        }
        fetches += 1u;
        let h = cell_corners(field, at);
        if line.height + line.rise * lowest <= max(max(h[0], h[1]), max(h[2], h[3])) {
            let inside = clamp(entry - vec2f(at.cell), vec2f(0.0), vec2f(1.0));
            let beyond = patch_crossing(h, inside, d, line, s, leave - s);
            if beyond < HUGE {
                return Walk(s + beyond, true, fetches, turns, true);
            }
        }
        passed = true;
    }
    return Walk(s, false, fetches, turns, false);
}
