//! Height maps that move over each other, blended into level 0 of a height map: `HeightLayers` of relievo-make.
//!
//! Gives the entry point `relievo_layer_heights`; declares its bindings.
//! Needs nothing.

// A layer at a moment.
struct RelievoLayer {
    // The first texel of its map among all, columns and rows.
    first: u32,
    columns: u32,
    rows: u32,
    pad: u32,
    repeat: vec2f,
    // Texture coordinates at the corner.
    offset: vec2f,
    factor: f32,
    pad_x: u32,
    pad_y: u32,
    pad_z: u32,
}

struct RelievoLayerTask {
    // Columns and rows of the blended map.
    size: vec2u,
    count: u32,
    // 0 sum, 1 product, 2 highest, 3 lowest.
    blend: u32,
}

@group(0) @binding(0) var<uniform> relievo_layer_task: RelievoLayerTask;
@group(0) @binding(1) var<storage, read> relievo_layers: array<RelievoLayer>;
@group(0) @binding(2) var relievo_layer_map: texture_storage_2d<r32float, write>;
@group(0) @binding(3) var<storage, read> relievo_layer_texels: array<f32>;

fn relievo_layer_texel(layer: RelievoLayer, x: i32, y: i32) -> f32 {
    let size = vec2i(i32(layer.columns), i32(layer.rows));
    let rest = vec2i(x, y) - (vec2i(x, y) / size) * size;
    let at = vec2u(select(rest, rest + size, rest < vec2i(0)));
    return relievo_layer_texels[layer.first + at.y * layer.columns + at.x];
}

// Bilinear, as `Grid::sample` of relievo-map.
fn relievo_layer_height(layer: RelievoLayer, uv: vec2f) -> f32 {
    let at = uv * vec2f(f32(layer.columns), f32(layer.rows)) - 0.5;
    let cell = floor(at);
    let f = at - cell;
    let i = vec2i(cell);
    let a = relievo_layer_texel(layer, i.x, i.y);
    let b = relievo_layer_texel(layer, i.x + 1, i.y);
    let c = relievo_layer_texel(layer, i.x, i.y + 1);
    let d = relievo_layer_texel(layer, i.x + 1, i.y + 1);
    let top = a + (b - a) * f.x;
    return top + ((c + (d - c) * f.x) - top) * f.y;
}

@compute @workgroup_size(8, 8)
fn relievo_layer_heights(@builtin(global_invocation_id) id: vec3u) {
    let task = relievo_layer_task;
    if any(id.xy >= task.size) {
        return;
    }
    let uv = (vec2f(id.xy) + 0.5) / vec2f(task.size);
    var sum = select(0.0, 1.0, task.blend == 1u || task.blend == 3u);
    for (var k = 0u; k < task.count; k++) {
        let layer = relievo_layers[k];
        let height = relievo_layer_height(layer, uv * layer.repeat + layer.offset) * layer.factor;
        switch task.blend {
            case 0u: { sum += height; }
            case 1u: { sum *= height; }
            case 2u: { sum = max(sum, height); }
            default: { sum = min(sum, height); }
        }
    }
    textureStore(relievo_layer_map, vec2i(id.xy), vec4f(min(max(sum, 0.0), 1.0), 0.0, 0.0, 1.0));
}
