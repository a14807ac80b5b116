//! A mip level of a height map from the one before, on the device: each texel the mean of what it covers. Into a buffer, to be
//! copied from there: OpenGL does not write a level of a texture of which it reads another.
//!
//! Gives the entry point `halve`; declares its bindings.
//! Needs nothing.

// One dispatch.
struct Part {
    // The first texel, and how many along u and v.
    first: vec2u,
    count: vec2u,
    // Texels from a row to the next in the buffer, and columns of the level.
    pitch: u32,
    columns: u32,
    pad: vec2u,
}

@group(0) @binding(0) var larger: texture_2d<f32>;
@group(0) @binding(1) var<uniform> part: Part;
// For each column, then for each row: how much of the texels 2x, 2x + 1 and 2x + 2 belongs to x.
@group(0) @binding(2) var<storage, read> weights: array<vec4f>;
@group(0) @binding(3) var<storage, read_write> smaller: array<f32>;

@compute @workgroup_size(8, 8)
fn halve(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= part.count) {
        return;
    }
    let at = part.first + id.xy;
    let last = textureDimensions(larger) - 1u;
    let columns = weights[at.x];
    let rows = weights[part.columns + at.y];
    var sum = 0.0;
    for (var y = 0u; y < 3u; y++) {
        for (var x = 0u; x < 3u; x++) {
            sum += textureLoad(larger, min(at * 2u + vec2u(x, y), last), 0).r * (columns[x] * rows[y]);
        }
    }
    smaller[at.y * part.pitch + at.x] = sum;
}
