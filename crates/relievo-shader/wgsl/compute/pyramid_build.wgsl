//! The max pyramid of a height map, built on the device: whole, or the nodes of a rectangle. What MaxPyramid of
//! relievo-march builds, code by code.
//!
//! Gives the entry points `pyramid_range` (lowest and highest height), `pyramid_base` (nodes of level 1 from heights),
//! `pyramid_above` (nodes of a level from those below), `pyramid_header`; declares their bindings.
//! Needs nothing.

// One dispatch.
struct Task {
    // The first node (texel, for the range), and how many along u and v.
    first: vec2u,
    count: vec2u,
    // Blocks of which nodes are made: cells, or nodes of the level below.
    blocks: vec2u,
    // The rows where the nodes of the level begin, and those below it. For the header: of the top, and of level 1.
    row: u32,
    below: u32,
    // Nodes from a row to the next.
    pitch: u32,
    // The mip level of the map.
    mip: u32,
    // Levels of the pyramid, for the header.
    levels: u32,
    // Not 0: codes of this level are summed.
    sums: u32,
    // The height of code 0 and the difference between two codes; 0 apart: by the map's own range.
    coding: vec2f,
    // Some devices ask for multiples of 16 bytes.
    pad: vec2u,
}

// Of each mip level: the lowest height's bits, inverted, and the highest's, so that both grow from 0; the sum of the codes
// of level 2; and nothing.
const STATE: u32 = 4u;

@group(0) @binding(0) var heights: texture_2d<f32>;
@group(0) @binding(1) var<uniform> task: Task;
@group(0) @binding(2) var<storage, read_write> nodes: array<vec4u>;
@group(0) @binding(3) var<storage, read_write> state: array<atomic<u32>>;

var<workgroup> lowest: atomic<u32>;
var<workgroup> highest: atomic<u32>;

// A texel on each side of 4×4.
@compute @workgroup_size(8, 8)
fn pyramid_range(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) local: u32) {
    let size = textureDimensions(heights);
    var low = 0u;
    var high = 0u;
    for (var k = 0u; k < 16u; k++) {
        let at = id.xy * 4u + vec2u(k & 3u, k >> 2u);
        if all(at < size) {
            // Bits of numbers from 0 on are in their order.
            let bits = bitcast<u32>(min(max(textureLoad(heights, at, 0).r, 0.0), 1.0)) & 0x7fffffffu;
            low = max(low, ~bits);
            high = max(high, bits);
        }
    }
    atomicMax(&lowest, low);
    atomicMax(&highest, high);
    workgroupBarrier();
    if local == 0u {
        atomicMax(&state[STATE * task.mip], atomicLoad(&lowest));
        atomicMax(&state[STATE * task.mip + 1u], atomicLoad(&highest));
    }
}

// The height of code 0 and the difference between two codes.
fn map_coding() -> vec2f {
    if task.coding.y != 0.0 {
        return task.coding;
    }
    let low = bitcast<f32>(~atomicLoad(&state[STATE * task.mip]));
    let high = bitcast<f32>(atomicLoad(&state[STATE * task.mip + 1u]));
    if low < high {
        return vec2f(low, (high - low) / 255.0);
    }
    return vec2f(0.0, 1.0 / 255.0);
}

// The smallest code whose height is not below h, but for rounding.
fn code(h: f32, coding: vec2f) -> u32 {
    return u32(min(max(ceil((h - coding.x) / coding.y - 1e-3), 0.0), 255.0));
}

fn height_at(x: u32, y: u32) -> f32 {
    // The last cells reach over to the first texels.
    return textureLoad(heights, vec2u(select(x, 0u, x >= task.blocks.x), select(y, 0u, y >= task.blocks.y)), 0).r;
}

// The higher ones of neighbours in a row of five texels.
fn higher(x: u32, y: u32) -> vec4f {
    let h = vec4f(height_at(x, y), height_at(x + 1u, y), height_at(x + 2u, y), height_at(x + 3u, y));
    return max(h, vec4f(h.yzw, height_at(x + 4u, y)));
}

@compute @workgroup_size(8, 8)
fn pyramid_base(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= task.count) {
        return;
    }
    let at = task.first + id.xy;
    let coding = map_coding();
    let cell = at * 4u;
    var node = vec4u(0u);
    var above = higher(cell.x, cell.y);
    for (var y = 0u; y < 4u; y++) {
        let below = higher(cell.x, cell.y + y + 1u);
        let h = max(above, below);
        above = below;
        if cell.y + y < task.blocks.y {
            for (var x = 0u; x < 4u; x++) {
                if cell.x + x < task.blocks.x {
                    node[y] |= code(h[x], coding) << (8u * x);
                }
            }
        }
    }
    nodes[(task.row + at.y) * task.pitch + at.x] = node;
}

fn highest_code(node: vec4u) -> u32 {
    let pair = max(max(node & vec4u(255u), (node >> vec4u(8u)) & vec4u(255u)),
        max((node >> vec4u(16u)) & vec4u(255u), node >> vec4u(24u)));
    return max(max(pair.x, pair.y), max(pair.z, pair.w));
}

fn sum_of_codes(node: vec4u) -> u32 {
    let sums = (node & vec4u(255u)) + ((node >> vec4u(8u)) & vec4u(255u)) + ((node >> vec4u(16u)) & vec4u(255u))
        + (node >> vec4u(24u));
    return sums.x + sums.y + sums.z + sums.w;
}

@compute @workgroup_size(8, 8)
fn pyramid_above(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= task.count) {
        return;
    }
    let at = task.first + id.xy;
    var node = vec4u(0u);
    for (var y = 0u; y < 4u; y++) {
        for (var x = 0u; x < 4u; x++) {
            let child = at * 4u + vec2u(x, y);
            if all(child < task.blocks) {
                node[y] |= highest_code(nodes[(task.below + child.y) * task.pitch + child.x]) << (8u * x);
            }
        }
    }
    let place = (task.row + at.y) * task.pitch + at.x;
    if task.sums != 0u {
        // What the sum grows by; less than 0 wraps round, and so does the sum.
        atomicAdd(&state[STATE * task.mip + 2u], sum_of_codes(node) - sum_of_codes(nodes[place]));
    }
    nodes[place] = node;
}

@compute @workgroup_size(1)
fn pyramid_header() {
    let coding = map_coding();
    var clearance = 0.0;
    if task.levels > 1u {
        // How far the blocks of 4×4 cells, one code of level 2 each, lie below the top on average.
        let count = task.blocks.x * task.blocks.y;
        let top = highest_code(nodes[task.row * task.pitch]);
        let below = top * count - atomicLoad(&state[STATE * task.mip + 2u]);
        clearance = f32(below) / f32(count) * coding.y;
    }
    nodes[task.mip] = vec4u(
        task.below | (task.levels << 24u), bitcast<u32>(coding.x), bitcast<u32>(coding.y), bitcast<u32>(clearance));
}
