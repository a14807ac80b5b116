//! A mip level of a height map from the one before, on the device: each texel the mean of what it covers. Into a buffer, to be
//! copied from there: OpenGL does not write a level of a texture of which it reads another.
//!
//! Gives the entry point `relievo_halve`; declares its bindings.
//! Needs nothing.

// One dispatch.
struct RelievoMipTask {
    // The first texel, and how many along u and v.
    first: vec2u,
    count: vec2u,
    // Texels from a row to the next in the buffer, and columns of the level.
    pitch: u32,
    columns: u32,
    pad: vec2u,
}

@group(0) @binding(0) var relievo_larger_mip: texture_2d<f32>;
@group(0) @binding(1) var<uniform> relievo_mip_task: RelievoMipTask;
// For each column, then for each row: how much of the texels 2x, 2x + 1 and 2x + 2 belongs to x.
@group(0) @binding(2) var<storage, read> relievo_mip_weights: array<vec4f>;
@group(0) @binding(3) var<storage, read_write> relievo_smaller_mip: array<f32>;

@compute @workgroup_size(8, 8)
fn relievo_halve(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= relievo_mip_task.count) {
        return;
    }
    let at = relievo_mip_task.first + id.xy;
    let last = textureDimensions(relievo_larger_mip) - 1u;
    let columns = relievo_mip_weights[at.x];
    let rows = relievo_mip_weights[relievo_mip_task.columns + at.y];
    var sum = 0.0;
    for (var y = 0u; y < 3u; y++) {
        for (var x = 0u; x < 3u; x++) {
            sum += textureLoad(relievo_larger_mip, min(at * 2u + vec2u(x, y), last), 0).r * (columns[x] * rows[y]);
        }
    }
    relievo_smaller_mip[at.y * relievo_mip_task.pitch + at.x] = sum;
}
