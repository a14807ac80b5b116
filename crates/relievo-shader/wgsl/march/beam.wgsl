//! One look ahead for a tile of neighbouring rays: how deep all of them go before the nearest can meet the surface. The same
//! steps as relievo-march/src/tile.rs.
//!
//! Gives RelievoTileEntry, RelievoRayBeam, relievo_beam_empty, relievo_beam_with, relievo_beam_entry.
//! Needs what descent.wgsl needs.
//! #import record
//! #import height
//! #import descent

// More steps than this are not worth their fetches.
const RELIEVO_BEAM_STEPS: u32 = 64u;
// Blocks along one axis that a step may look at.
const RELIEVO_BEAM_BLOCKS: u32 = 16u;

struct RelievoTileEntry {
    // All rays are above the surface down to this depth.
    depth: f32,
    // Nodes of the pyramid that were loaded, once for all rays.
    fetches: u32,
}

// A box of rays: positions on the lid in texel-centre coordinates, and ways per unit of depth.
struct RelievoRayBeam {
    low: vec2f,
    high: vec2f,
    slope_min: vec2f,
    slope_max: vec2f,
    // Not so where one is no ray that could be marched.
    usable: bool,
}

fn relievo_beam_empty() -> RelievoRayBeam {
    return RelievoRayBeam(vec2f(RELIEVO_HUGE), vec2f(-RELIEVO_HUGE), vec2f(RELIEVO_HUGE), vec2f(-RELIEVO_HUGE), true);
}

// The box with one ray more.
fn relievo_beam_with(
    beam: RelievoRayBeam, ray: RelievoRay, field: RelievoHeightField, options: RelievoMarchOptions,
) -> RelievoRayBeam {
    let size = vec2f(field.size);
    let slope = relievo_ray_slope(ray);
    let at = relievo_uv_on_lid(ray.uv, slope, options) * size - 0.5;
    let texel_slope = slope * size;
    return RelievoRayBeam(
        min(beam.low, at), max(beam.high, at), min(beam.slope_min, texel_slope), max(beam.slope_max, texel_slope),
        beam.usable && relievo_ray_is_usable(ray, field.size));
}

// The blocks along one axis that a stretch of cells touches.
struct RelievoAxisBlock {
    // The cell where the block of the moment is entered, from 0 on; its place in the map, and which way that faces.
    cell: i32,
    index: i32,
    mirror_sign: i32,
}

fn relievo_axis_block(first: i32, n: i32) -> RelievoAxisBlock {
    let place = relievo_axis_cell(first, n);
    return RelievoAxisBlock(first, place[0], place[1]);
}

fn relievo_axis_block_next(blocks: RelievoAxisBlock, bit_shift: u32, n: i32) -> RelievoAxisBlock {
    let cells = relievo_cells_to_exit(blocks.index, blocks.mirror_sign, bit_shift, n);
    if cells == RELIEVO_NEVER {
        return RelievoAxisBlock(RELIEVO_NEVER, blocks.index, blocks.mirror_sign);
    }
    let place = relievo_axis_cell_beyond(blocks.index + blocks.mirror_sign * cells, blocks.mirror_sign, n);
    return RelievoAxisBlock(blocks.cell + cells, place[0], place[1]);
}

fn relievo_axis_block_index(blocks: RelievoAxisBlock, bit_shift: u32, n: i32) -> u32 {
    return u32(clamp(blocks.index, 0, n - 1)) >> bit_shift;
}

// How many blocks there are up to the cell `last`, at most one more than may be; and in how many nodes in a row.
fn relievo_axis_block_count(first: i32, last: i32, bit_shift: u32, n: i32) -> vec2u {
    var blocks = relievo_axis_block(first, n);
    var count = vec2u(0u);
    var before = 0u;
    while blocks.cell <= last && count.x <= RELIEVO_BEAM_BLOCKS {
        let node = relievo_axis_block_index(blocks, bit_shift, n) >> 2u;
        count += vec2u(1u, select(1u, 0u, count.x > 0u && node == before));
        before = node;
        blocks = relievo_axis_block_next(blocks, bit_shift, n);
    }
    return count;
}

// The highest code of the blocks that the beam crosses between two depths, and the nodes they are in: none if there are too
// many blocks.
fn relievo_beam_highest(
    field: RelievoHeightField, beam: RelievoRayBeam, level: u32, row: i32, start: f32, end: f32,
) -> vec2u {
    let bit_shift = 2u * (level - 1u);
    let near = beam.low + min(beam.slope_min * start, beam.slope_min * end);
    let far = beam.high + max(beam.slope_max * start, beam.slope_max * end);
    // Rounding may have moved the rays themselves.
    let margin = 1e-3 + 4.0 * 1.1920929e-7 * max(abs(near), abs(far));
    let first = vec2i(floor(near - margin));
    let last = vec2i(floor(far + margin));
    let columns = relievo_axis_block_count(first.x, last.x, bit_shift, field.size.x);
    let rows = relievo_axis_block_count(first.y, last.y, bit_shift, field.size.y);
    if columns.x > RELIEVO_BEAM_BLOCKS || rows.x > RELIEVO_BEAM_BLOCKS {
        return vec2u(0u);
    }
    var highest = 0u;
    var y = relievo_axis_block(first.y, field.size.y);
    for (var j = 0u; j < rows.x; j++) {
        let v = relievo_axis_block_index(y, bit_shift, field.size.y);
        var x = relievo_axis_block(first.x, field.size.x);
        var row_maxima = 0u;
        var before = 0u;
        for (var i = 0u; i < columns.x; i++) {
            let u = relievo_axis_block_index(x, bit_shift, field.size.x);
            if i == 0u || (u >> 2u) != before {
                before = u >> 2u;
                row_maxima = relievo_load_node(row, vec2u(before, v >> 2u))[v & 3u];
            }
            highest = max(highest, (row_maxima >> (8u * (u & 3u))) & 0xffu);
            x = relievo_axis_block_next(x, bit_shift, field.size.x);
        }
        y = relievo_axis_block_next(y, bit_shift, field.size.y);
    }
    return vec2u(highest, columns.y * rows.y);
}

// How deep all rays of the beam stay above the surface: a lower bound, 0 where nothing is known.
fn relievo_beam_entry(field: RelievoHeightField, beam: RelievoRayBeam) -> RelievoTileEntry {
    if !beam.usable || RELIEVO_WITHOUT_PYRAMID || relievo_is_stretched(field) {
        return RelievoTileEntry(0.0, 0u);
    }
    let header = textureLoad(relievo_pyramid, vec2i(field.level, 0), 0);
    let top = header.x >> 24u;
    let lowest = bitcast<f32>(header.y);
    let code = bitcast<f32>(header.z);
    let slack = RELIEVO_CODE_SLACK * code + 4.0 * 1.1920929e-7;
    let bottom = 1.0 - field.range.x;
    let speeds = max(abs(beam.slope_min), abs(beam.slope_max));
    let texel_slope = max(speeds.x, speeds.y);
    let widths = beam.high - beam.low;
    let width = max(0.0, max(widths.x, widths.y));
    // Blocks much smaller than the beam cost more than they tell.
    let finest = min(1u + select(0u, 1u, width >= 12.0) + select(0u, 1u, width >= 48.0), top);
    var level = min(max(relievo_start_level(texel_slope * bitcast<f32>(header.w), top), finest), top);
    var row = relievo_level_row(field.size, header, level);
    var entry = RelievoTileEntry(1.0 - field.range.y, 0u);
    for (var k = 0u; k < RELIEVO_BEAM_STEPS; k++) {
        let block = f32(1u << (2u * (level - 1u)));
        // Straight down there is no way to go.
        let end = min(select(bottom, entry.depth + 2.0 * block / texel_slope, texel_slope > 0.0), bottom);
        let found = relievo_beam_highest(field, beam, level, row, entry.depth, end);
        if found.y == 0u {
            break;
        }
        entry.fetches += found.y;
        // Above everything in the box until here.
        let free = 1.0 - (lowest + f32(found.x) * code) - slack;
        if free >= end {
            entry.depth = end;
            if level < top {
                row += relievo_node_rows(field.size, level);
                level += 1u;
            }
        } else {
            let half = 0.5 * (entry.depth + end);
            entry.depth = max(entry.depth, free);
            if free > half {
                continue;
            }
            if level <= finest {
                break;
            }
            level -= 1u;
            row -= relievo_node_rows(field.size, level);
        }
        if entry.depth >= bottom {
            break;
        }
    }
    return entry;
}
