//! One look ahead for a tile of neighbouring rays: how deep all of them go before the nearest can meet the surface. The same
//! steps as relievo-march/src/tile.rs.
//!
//! Gives TileEntry, Beam, beam_empty, beam_with, beam_entry.
//! Needs what descent.wgsl needs.
//! #import record
//! #import height
//! #import descent

// More steps than this are not worth their fetches.
const BEAM_STEPS: u32 = 64u;
// Blocks along one axis that a step may look at.
const BEAM_BLOCKS: u32 = 16u;

struct TileEntry {
    // All rays are above the surface down to this depth.
    depth: f32,
    // Nodes of the pyramid that were loaded, once for all rays.
    fetches: u32,
}

// A box of rays: positions on the lid in texel-centre coordinates, and ways per unit of depth.
struct Beam {
    low: vec2f,
    high: vec2f,
    slowest: vec2f,
    fastest: vec2f,
    // Not so where one is no ray that could be marched.
    usable: bool,
}

fn beam_empty() -> Beam {
    return Beam(vec2f(HUGE), vec2f(-HUGE), vec2f(HUGE), vec2f(-HUGE), true);
}

// The box with one ray more.
fn beam_with(beam: Beam, ray: Ray, field: Field, how: March) -> Beam {
    let size = vec2f(field.size);
    let slope = ray_slope(ray);
    let at = uv_on_lid(ray.uv, slope, how) * size - 0.5;
    let way = slope * size;
    return Beam(
        min(beam.low, at), max(beam.high, at), min(beam.slowest, way), max(beam.fastest, way),
        beam.usable && ray_is_usable(ray, field.size));
}

// The blocks along one axis that a stretch of cells touches.
struct Blocks {
    // The cell where the block of the moment is entered, from 0 on; its place in the map, and which way that faces.
    cell: i32,
    index: i32,
    facing: i32,
}

fn blocks_from(first: i32, n: i32) -> Blocks {
    let place = height_place(first, n);
    return Blocks(first, place[0], place[1]);
}

fn blocks_next(blocks: Blocks, shift: u32, n: i32) -> Blocks {
    let cells = height_leave(blocks.index, blocks.facing, shift, n);
    if cells == NEVER {
        return Blocks(NEVER, blocks.index, blocks.facing);
    }
    let place = height_beyond(blocks.index + blocks.facing * cells, blocks.facing, n);
    return Blocks(blocks.cell + cells, place[0], place[1]);
}

fn block_number(blocks: Blocks, shift: u32, n: i32) -> u32 {
    return u32(clamp(blocks.index, 0, n - 1)) >> shift;
}

// How many blocks there are up to the cell `last`, at most one more than may be; and in how many nodes in a row.
fn blocks_count(first: i32, last: i32, shift: u32, n: i32) -> vec2u {
    var blocks = blocks_from(first, n);
    var count = vec2u(0u);
    var before = 0u;
    while blocks.cell <= last && count.x <= BEAM_BLOCKS {
        let node = block_number(blocks, shift, n) >> 2u;
        count += vec2u(1u, select(1u, 0u, count.x > 0u && node == before));
        before = node;
        blocks = blocks_next(blocks, shift, n);
    }
    return count;
}

// The highest code of the blocks that the beam crosses between two depths, and the nodes they are in: none if there are too
// many blocks.
fn beam_highest(field: Field, beam: Beam, level: u32, row: i32, start: f32, end: f32) -> vec2u {
    let shift = 2u * (level - 1u);
    let near = beam.low + min(beam.slowest * start, beam.slowest * end);
    let far = beam.high + max(beam.fastest * start, beam.fastest * end);
    // Rounding may have moved the rays themselves.
    let margin = 1e-3 + 4.0 * 1.1920929e-7 * max(abs(near), abs(far));
    let first = vec2i(floor(near - margin));
    let last = vec2i(floor(far + margin));
    let columns = blocks_count(first.x, last.x, shift, field.size.x);
    let rows = blocks_count(first.y, last.y, shift, field.size.y);
    if columns.x > BEAM_BLOCKS || rows.x > BEAM_BLOCKS {
        return vec2u(0u);
    }
    var highest = 0u;
    var y = blocks_from(first.y, field.size.y);
    for (var j = 0u; j < rows.x; j++) {
        let v = block_number(y, shift, field.size.y);
        var x = blocks_from(first.x, field.size.x);
        var codes = 0u;
        var before = 0u;
        for (var i = 0u; i < columns.x; i++) {
            let u = block_number(x, shift, field.size.x);
            if i == 0u || (u >> 2u) != before {
                before = u >> 2u;
                codes = load_node(row, vec2u(before, v >> 2u))[v & 3u];
            }
            highest = max(highest, (codes >> (8u * (u & 3u))) & 0xffu);
            x = blocks_next(x, shift, field.size.x);
        }
        y = blocks_next(y, shift, field.size.y);
    }
    return vec2u(highest, columns.y * rows.y);
}

// How deep all rays of the beam stay above the surface: a lower bound, 0 where nothing is known.
fn beam_entry(field: Field, beam: Beam) -> TileEntry {
    if !beam.usable || field.stretch.x > 0 {
        return TileEntry(0.0, 0u);
    }
    let header = textureLoad(relief_pyramid, vec2i(field.level, 0), 0);
    let top = header.x >> 24u;
    let lowest = bitcast<f32>(header.y);
    let code = bitcast<f32>(header.z);
    let slack = CODE_SLACK * code + 4.0 * 1.1920929e-7;
    let bottom = 1.0 - field.range.x;
    let ways = max(abs(beam.slowest), abs(beam.fastest));
    let way = max(ways.x, ways.y);
    let widths = beam.high - beam.low;
    let width = max(0.0, max(widths.x, widths.y));
    // Blocks much smaller than the beam cost more than they tell.
    let finest = min(1u + select(0u, 1u, width >= 12.0) + select(0u, 1u, width >= 48.0), top);
    var level = min(max(start_level(way * bitcast<f32>(header.w), top), finest), top);
    var row = i32(header.x & 0xffffffu);
    for (var below = 1u; below < level; below++) {
        row += node_rows(field.size, below);
    }
    var entry = TileEntry(1.0 - field.range.y, 0u);
    for (var k = 0u; k < BEAM_STEPS; k++) {
        let block = f32(1u << (2u * (level - 1u)));
        // Straight down there is no way to go.
        let end = min(select(bottom, entry.depth + 2.0 * block / way, way > 0.0), bottom);
        let found = beam_highest(field, beam, level, row, entry.depth, end);
        if found.y == 0u {
            break;
        }
        entry.fetches += found.y;
        // Above everything in the box until here.
        let free = 1.0 - (lowest + f32(found.x) * code) - slack;
        if free >= end {
            entry.depth = end;
            if level < top {
                row += node_rows(field.size, level);
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
            row -= node_rows(field.size, level);
        }
        if entry.depth >= bottom {
            break;
        }
    }
    return entry;
}
