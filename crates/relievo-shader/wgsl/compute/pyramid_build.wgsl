//! The max pyramid of a height map, built on the device: whole, or the nodes of a rectangle. What MaxPyramid of
//! relievo-march builds, code by code.
//!
//! Gives the entry points `relievo_pyramid_range` (lowest and highest height), `relievo_pyramid_base` (nodes of level 1
//! from heights), `relievo_pyramid_above` (nodes of a level from those below), `relievo_pyramid_header`; declares their
//! bindings.
//! Needs nothing.

// One dispatch.
struct RelievoPyramidTask {
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
    quantization: vec2f,
    // Some devices ask for multiples of 16 bytes.
    pad: vec2u,
}

// Of each mip level: the lowest height's bits, inverted, and the highest's, so that both grow from 0; the sum of the codes
// of level 2; and nothing.
const RELIEVO_STATE_WORDS: u32 = 4u;

@group(0) @binding(0) var relievo_level_heights: texture_2d<f32>;
@group(0) @binding(1) var<uniform> relievo_pyramid_task: RelievoPyramidTask;
@group(0) @binding(2) var<storage, read_write> relievo_pyramid_nodes: array<vec4u>;
@group(0) @binding(3) var<storage, read_write> relievo_pyramid_state: array<atomic<u32>>;

var<workgroup> relievo_lowest_bits: atomic<u32>;
var<workgroup> relievo_highest_bits: atomic<u32>;

// A texel on each side of 4×4.
@compute @workgroup_size(8, 8)
fn relievo_pyramid_range(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) local: u32) {
    let size = textureDimensions(relievo_level_heights);
    var low = 0u;
    var high = 0u;
    for (var k = 0u; k < 16u; k++) {
        let at = id.xy * 4u + vec2u(k & 3u, k >> 2u);
        if all(at < size) {
            // Bits of numbers from 0 on are in their order.
            let bits = bitcast<u32>(min(max(textureLoad(relievo_level_heights, at, 0).r, 0.0), 1.0)) & 0x7fffffffu;
            low = max(low, ~bits);
            high = max(high, bits);
        }
    }
    atomicMax(&relievo_lowest_bits, low);
    atomicMax(&relievo_highest_bits, high);
    workgroupBarrier();
    if local == 0u {
        atomicMax(&relievo_pyramid_state[RELIEVO_STATE_WORDS * relievo_pyramid_task.mip], atomicLoad(&relievo_lowest_bits));
        atomicMax(&relievo_pyramid_state[RELIEVO_STATE_WORDS * relievo_pyramid_task.mip + 1u], atomicLoad(&relievo_highest_bits));
    }
}

// The height of code 0 and the difference between two codes.
fn relievo_map_quantization() -> vec2f {
    if relievo_pyramid_task.quantization.y != 0.0 {
        return relievo_pyramid_task.quantization;
    }
    let low = bitcast<f32>(~atomicLoad(&relievo_pyramid_state[RELIEVO_STATE_WORDS * relievo_pyramid_task.mip]));
    let high = bitcast<f32>(atomicLoad(&relievo_pyramid_state[RELIEVO_STATE_WORDS * relievo_pyramid_task.mip + 1u]));
    if low < high {
        return vec2f(low, (high - low) / 255.0);
    }
    return vec2f(0.0, 1.0 / 255.0);
}

// The smallest code whose height is not below h, but for rounding.
fn relievo_quantize(h: f32, quantization: vec2f) -> u32 {
    return u32(min(max(ceil((h - quantization.x) / quantization.y - 1e-3), 0.0), 255.0));
}

fn relievo_height_at(x: u32, y: u32) -> f32 {
    // The last cells reach over to the first texels.
    let blocks = relievo_pyramid_task.blocks;
    return textureLoad(relievo_level_heights, vec2u(select(x, 0u, x >= blocks.x), select(y, 0u, y >= blocks.y)), 0).r;
}

// The higher ones of neighbours in a row of five texels.
fn relievo_row_maxima(x: u32, y: u32) -> vec4f {
    let h =
        vec4f(relievo_height_at(x, y), relievo_height_at(x + 1u, y), relievo_height_at(x + 2u, y), relievo_height_at(x + 3u, y));
    return max(h, vec4f(h.yzw, relievo_height_at(x + 4u, y)));
}

@compute @workgroup_size(8, 8)
fn relievo_pyramid_base(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= relievo_pyramid_task.count) {
        return;
    }
    let at = relievo_pyramid_task.first + id.xy;
    let quantization = relievo_map_quantization();
    let cell = at * 4u;
    var node = vec4u(0u);
    var above = relievo_row_maxima(cell.x, cell.y);
    for (var y = 0u; y < 4u; y++) {
        let below = relievo_row_maxima(cell.x, cell.y + y + 1u);
        let h = max(above, below);
        above = below;
        if cell.y + y < relievo_pyramid_task.blocks.y {
            for (var x = 0u; x < 4u; x++) {
                if cell.x + x < relievo_pyramid_task.blocks.x {
                    node[y] |= relievo_quantize(h[x], quantization) << (8u * x);
                }
            }
        }
    }
    relievo_pyramid_nodes[(relievo_pyramid_task.row + at.y) * relievo_pyramid_task.pitch + at.x] = node;
}

fn relievo_node_maximum(node: vec4u) -> u32 {
    let pair = max(max(node & vec4u(255u), (node >> vec4u(8u)) & vec4u(255u)),
        max((node >> vec4u(16u)) & vec4u(255u), node >> vec4u(24u)));
    return max(max(pair.x, pair.y), max(pair.z, pair.w));
}

fn relievo_node_sum(node: vec4u) -> u32 {
    let sums = (node & vec4u(255u)) + ((node >> vec4u(8u)) & vec4u(255u)) + ((node >> vec4u(16u)) & vec4u(255u))
        + (node >> vec4u(24u));
    return sums.x + sums.y + sums.z + sums.w;
}

@compute @workgroup_size(8, 8)
fn relievo_pyramid_above(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= relievo_pyramid_task.count) {
        return;
    }
    let at = relievo_pyramid_task.first + id.xy;
    var node = vec4u(0u);
    for (var y = 0u; y < 4u; y++) {
        for (var x = 0u; x < 4u; x++) {
            let child = at * 4u + vec2u(x, y);
            if all(child < relievo_pyramid_task.blocks) {
                let below = (relievo_pyramid_task.below + child.y) * relievo_pyramid_task.pitch + child.x;
                node[y] |= relievo_node_maximum(relievo_pyramid_nodes[below]) << (8u * x);
            }
        }
    }
    let index = (relievo_pyramid_task.row + at.y) * relievo_pyramid_task.pitch + at.x;
    if relievo_pyramid_task.sums != 0u {
        // What the sum grows by; less than 0 wraps round, and so does the sum.
        atomicAdd(
            &relievo_pyramid_state[RELIEVO_STATE_WORDS * relievo_pyramid_task.mip + 2u],
            relievo_node_sum(node) - relievo_node_sum(relievo_pyramid_nodes[index]));
    }
    relievo_pyramid_nodes[index] = node;
}

@compute @workgroup_size(1)
fn relievo_pyramid_header() {
    let quantization = relievo_map_quantization();
    var clearance = 0.0;
    if relievo_pyramid_task.levels > 1u {
        // How far the blocks of 4×4 cells, one code of level 2 each, lie below the top on average.
        let count = relievo_pyramid_task.blocks.x * relievo_pyramid_task.blocks.y;
        let top = relievo_node_maximum(relievo_pyramid_nodes[relievo_pyramid_task.row * relievo_pyramid_task.pitch]);
        let below = top * count - atomicLoad(&relievo_pyramid_state[RELIEVO_STATE_WORDS * relievo_pyramid_task.mip + 2u]);
        clearance = f32(below) / f32(count) * quantization.y;
    }
    relievo_pyramid_nodes[relievo_pyramid_task.mip] = vec4u(
        relievo_pyramid_task.below | (relievo_pyramid_task.levels << 24u), bitcast<u32>(quantization.x),
        bitcast<u32>(quantization.y), bitcast<u32>(clearance));
}
