//! The exact march through the max pyramid: the same cells with the same borders as walk.wgsl, but for those in blocks that
//! the line passes above. The same steps as relievo-march/src/descent.rs, so that hits and costs agree.
//!
//! Gives relievo_first_crossing, relievo_descend, relievo_path_code.
//! Needs what height.wgsl needs, and a global `relievo_pyramid: texture_2d<u32>` (see HeightTexture): the header of mip level
//! l is texel (l, 0): row of the lowest nodes and, from bit 24 on, number of levels; then as f32 the height of code 0, the
//! height of one code more, and how far blocks lie below the top. A node is the highest codes of 4×4 blocks, a row to a
//! channel, the first in the lowest byte; the rows of each level follow those of the one below.
//! #import record
//! #import height
//! #import walk
//! #import chosen_path

// The longest march, as long as the plain walk's: a turn goes a cell further or more, or a level down after one that did.
const RELIEVO_MAX_ITERATIONS: u32 = RELIEVO_MAX_CELLS;
// How far above a block's code a line must be to pass over it: covers the rounding of codes and lines.
const RELIEVO_CODE_SLACK: f32 = 0.00390625;
// How far rounding may put a point beside its cell, in texels.
const RELIEVO_POINT_SLACK: f32 = 0.015625;
// A block that goes on for ever.
const RELIEVO_NEVER: i32 = 1 << 30u;

// Where a line is: in the endless grid of cells, counted from the one it starts in, and in the map.
struct RelievoGridCell {
    cell: vec2i,
    index: vec2i,
    // -1 where the map stands mirrored.
    mirror_sign: vec2i,
}

// The first s in [start, end] at which the line is on or below the surface.
fn relievo_first_crossing(field: RelievoHeightField, line: RelievoHeightLine, start: f32, end: f32) -> RelievoCellWalk {
    // Known before, where it is not so: adapters in software go through both branches.
    if RELIEVO_WITHOUT_PYRAMID || (RELIEVO_FIELD_STRETCHES && relievo_is_stretched(field)) {
        // A stretched field's border is not the map's.
        return relievo_walk_to_crossing(field, line, start, end, RELIEVO_MAX_CELLS);
    }
    let header = textureLoad(relievo_pyramid, vec2i(field.level, 0), 0);
    return relievo_descend(field, relievo_path_of_line(field, line, relievo_path_code(header)), start, end, header);
}

// The same at, `cells` further along both axes; at most the first one beyond the block.
fn relievo_advance(at: RelievoGridCell, step: vec2i, cells: vec2i, size: vec2i) -> RelievoGridCell {
    let index = at.index + step * at.mirror_sign * cells;
    let x = relievo_axis_cell_beyond(index.x, at.mirror_sign.x, size.x);
    let y = relievo_axis_cell_beyond(index.y, at.mirror_sign.y, size.y);
    return RelievoGridCell(at.cell + step * cells, vec2i(x[0], y[0]), vec2i(x[1], y[1]));
}

// The texels on both sides of a cell, in the order in which the endless row has them.
fn relievo_cell_texels(index: i32, mirror_sign: i32, n: i32) -> vec2i {
    let first = clamp(index, 0, n - 1);
    let second = select(max(index + 1, 0), relievo_last_texel(n), index >= n - 1);
    return select(vec2i(second, first), vec2i(first, second), mirror_sign > 0);
}

fn relievo_cell_corners(field: RelievoHeightField, at: RelievoGridCell) -> vec4f {
    let x = relievo_cell_texels(at.index.x, at.mirror_sign.x, field.size.x);
    let y = relievo_cell_texels(at.index.y, at.mirror_sign.y, field.size.y);
    return vec4f(
        textureLoad(relievo_heights, vec2i(x[0], y[0]), field.level).r,
        textureLoad(relievo_heights, vec2i(x[1], y[0]), field.level).r,
        textureLoad(relievo_heights, vec2i(x[0], y[1]), field.level).r,
        textureLoad(relievo_heights, vec2i(x[1], y[1]), field.level).r,
    );
}

// The node above a node, or the one that has a cell, of a level.
fn relievo_node_texel(at: RelievoGridCell, size: vec2i) -> vec2u {
    return vec2u(clamp(at.index, vec2i(0), size - 1));
}

// Rows of nodes of a level.
fn relievo_node_rows(size: vec2i, level: u32) -> i32 {
    return (size.y + (1 << (2u * level)) - 1) >> (2u * level);
}

fn relievo_load_node(row: i32, at: vec2u) -> vec4u {
    return textureLoad(relievo_pyramid, vec2i(at) + vec2i(0, row), 0);
}

// The level at which to begin a march that is likely to go this many texels before it comes near the surface.
fn relievo_start_level(texels: f32, top: u32) -> u32 {
    let level = 1u + select(0u, 1u, texels >= 2.0) + select(0u, 1u, texels >= 16.0) + select(0u, 1u, texels >= 128.0);
    return min(level, top);
}

// The row where the nodes of a pyramid level begin; `header` as in the texture.
fn relievo_level_row(size: vec2i, header: vec4u, level: u32) -> i32 {
    var row = i32(header.x & 0xffffffu);
    for (var below = 1u; below < level; below++) {
        row += relievo_node_rows(size, below);
    }
    return row;
}

// The height of code 0 in codes, with the slack, and codes per unit of height; `header` as in the texture.
fn relievo_path_code(header: vec4u) -> vec2f {
    let per_step = 1.0 / bitcast<f32>(header.z);
    let slack = RELIEVO_CODE_SLACK + 4.0 * 1.1920929e-7 * per_step;
    return vec2f(bitcast<f32>(header.y) * per_step + slack, per_step);
}

// Where the line is when it is in a cell, counted from the one it starts in.
fn relievo_grid_cell(grid: RelievoGridLine, cell: vec2i, size: vec2i) -> RelievoGridCell {
    let x = relievo_axis_cell(grid.first.x + cell.x, size.x);
    let y = relievo_axis_cell(grid.first.y + cell.y, size.y);
    return RelievoGridCell(cell, vec2i(x[0], y[0]), vec2i(x[1], y[1]));
}

// The highest code of the block of a node that a cell is in.
fn relievo_block_code(node: vec4u, at: RelievoGridCell, bit_shift: u32, size: vec2i) -> u32 {
    let child = (relievo_node_texel(at, size) >> vec2u(bit_shift)) & vec2u(3u);
    let half = select(node.xy, node.zw, child.y > 1u);
    return (select(half.x, half.y, (child.y & 1u) != 0u) >> (8u * child.x)) & 0xffu;
}

// Where the line leaves its block.
struct RelievoBlockExit {
    // Cells up to the end of the block, the one it is in among them.
    cells: vec2i,
    s: f32,
    along_v: bool,
}

fn relievo_block_exit(path: RelievoPath, at: RelievoGridCell, bit_shift: u32, size: vec2i) -> RelievoBlockExit {
    let grid = path.grid;
    let cells = vec2i(
        relievo_cells_to_exit(at.index.x, grid.step.x * at.mirror_sign.x, bit_shift, size.x),
        relievo_cells_to_exit(at.index.y, grid.step.y * at.mirror_sign.y, bit_shift, size.y),
    );
    let edge = at.cell + grid.step * (cells - 1) + grid.border_offset;
    let t_max = select(relievo_path_crossings(path, edge), vec2f(RELIEVO_HUGE), cells == vec2i(RELIEVO_NEVER));
    let along_v = t_max.y < t_max.x;
    return RelievoBlockExit(cells, select(t_max.x, t_max.y, along_v), along_v);
}

// The cell beyond a block's exit, at `s`. The plain walk crosses borders by s, at the same s columns first: the cell across is
// the one that lies between borders so crossed, this one or the next.
fn relievo_cell_beyond(
    path: RelievoPath, at: RelievoGridCell, exit: RelievoBlockExit, entry: vec2f, size: vec2i,
) -> RelievoGridCell {
    let grid = path.grid;
    let progress =
        select(vec2f(at.cell + 1) - entry, entry - vec2f(at.cell), grid.step > vec2i(0)) - RELIEVO_POINT_SLACK;
    let whole = min(vec2i(max(progress, vec2f(0.0))), exit.cells - 1);
    let edge = at.cell + grid.step * whole + grid.border_offset;
    let t_at_border = relievo_path_crossing(path, select(edge.y, edge.x, exit.along_v), !exit.along_v);
    let crossed = select(
        t_at_border < exit.s && whole.y < exit.cells.y - 1,
        t_at_border <= exit.s && whole.x < exit.cells.x - 1,
        exit.along_v);
    let more = select(0, 1, crossed);
    let moved = select(vec2i(exit.cells.x, whole.y + more), vec2i(whole.x + more, exit.cells.y), exit.along_v);
    return relievo_advance(at, grid.step, moved, size);
}

// Where the line enters a cell, near `entry`, by a border along u (of a row) or v. It crosses this border exactly; rounding must
// not put it beside.
fn relievo_cell_entry(grid: RelievoGridLine, cell: vec2i, entry: vec2f, along_v: bool) -> vec2f {
    let exact = vec2f(cell - grid.step + grid.border_offset);
    return select(vec2f(exact.x, entry.y), vec2f(entry.x, exact.y), along_v);
}

// The level to begin at: from the lid down there is a way to go; elsewhere the surface is near.
fn relievo_first_level(field: RelievoHeightField, path: RelievoPath, start: f32, header: vec4u) -> u32 {
    let height_and_speed = relievo_path_height_and_speed(path, start);
    if height_and_speed.x < field.range.y - 1e-6 {
        return 1u;
    }
    return relievo_start_level(bitcast<f32>(header.w) * height_and_speed.y, header.x >> 24u);
}

// Two loops, one in the other, so that neighbours look for their cells together and then at their patches together.
// `level`, `row`, `here`: the level of the node, the row where that begins, and the node in it; `fresh`: it is still to be
// loaded. `parent`: the node above, where it was loaded on the way down. `passed`: the cell's patch has been looked at, and
// is not met. All are local variables: in a structure of its own the node took 3 to 5 % longer (llvmpipe).
fn relievo_descend(field: RelievoHeightField, path: RelievoPath, start: f32, end: f32, header: vec4u) -> RelievoCellWalk {
    let grid = path.grid;
    var s = start;
    var came = relievo_path_at(path, s);
    var entry = came.position;
    var at = relievo_grid_cell(grid, vec2i(floor(entry)), field.size);
    var level = relievo_first_level(field, path, start, header);
    var row = relievo_level_row(field.size, header, level);
    var here = relievo_node_texel(at, field.size) >> vec2u(2u * level);
    var node = vec4u(0u);
    var fresh = true;
    var parent = vec4u(0u);
    var has_parent = false;
    var fetches = 0u;
    var iterations = 0u;
    var passed = false;
    var t_exit = start;
    for (var tests = 0u; tests < RELIEVO_MAX_ITERATIONS; tests++) {
        var found = false;
        while iterations < RELIEVO_MAX_ITERATIONS || passed {
            if fresh {
                node = relievo_load_node(row, here);
                fetches += 1u;
                fresh = false;
            }
            iterations += select(1u, 0u, passed);
            let bit_shift = 2u * (level - 1u);
            let highest = relievo_block_code(node, at, bit_shift, field.size);
            let exit = relievo_block_exit(path, at, bit_shift, field.size);
            t_exit = min(max(exit.s, s), end);
            let out = relievo_path_at(path, t_exit);
            if relievo_path_lowest(path, came, out, t_exit - s) <= f32(highest) && !passed {
                if level == 1u {
                    found = true;
                    break;
                }
                level -= 1u;
                row -= relievo_node_rows(field.size, level);
                here = relievo_node_texel(at, field.size) >> vec2u(2u * level);
                parent = node;
                has_parent = true;
                fresh = true;
                continue;
            }
            passed = false;
            if t_exit >= end {
                return RelievoCellWalk(end, false, fetches, iterations, true);
            }
            s = t_exit;
            came = out;
            at = relievo_cell_beyond(path, at, exit, out.position, field.size);
            entry = relievo_cell_entry(grid, at.cell, out.position, exit.along_v);
            let before = here;
            here = relievo_node_texel(at, field.size) >> vec2u(2u * level);
            if all(here == before) {
                continue;
            }
            let same_parent = all((before >> vec2u(2u)) == (here >> vec2u(2u)));
            fresh = !(has_parent && same_parent);
            node = select(node, parent, !fresh);
            has_parent = false;
            if (!fresh || !same_parent) && level < (header.x >> 24u) {
                row += relievo_node_rows(field.size, level);
                level += 1u;
                here = here >> vec2u(2u);
            }
        }
        if !found {
            break;
        }
        fetches += 1u;
        let beyond = relievo_path_patch(path, relievo_cell_corners(field, at), at.cell, entry, s, t_exit);
        if beyond < RELIEVO_HUGE {
            return RelievoCellWalk(s + beyond, true, fetches, iterations, true);
        }
        passed = true;
    }
    return RelievoCellWalk(s, false, fetches, iterations, false);
}
