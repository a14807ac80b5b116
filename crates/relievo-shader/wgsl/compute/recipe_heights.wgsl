//! The heights of a recipe, into level 0 of a height map. `chosen_recipe` gives relievo_recipe_height(uv, phase): the
//! `HeightProgram` of relievo-make.
//!
//! Gives the entry point `relievo_recipe_heights`; declares its bindings.
//! #import chosen_recipe

struct RelievoRecipeTask {
    // Texels per side, and samples along each side of a texel.
    size: u32,
    samples: u32,
    // Part of the loop that has passed.
    phase: f32,
    pad: u32,
}

@group(0) @binding(0) var<uniform> relievo_recipe_task: RelievoRecipeTask;
@group(0) @binding(2) var relievo_recipe_map: texture_storage_2d<r32float, write>;

@compute @workgroup_size(8, 8)
fn relievo_recipe_heights(@builtin(global_invocation_id) id: vec3u) {
    let task = relievo_recipe_task;
    if any(id.xy >= vec2u(task.size)) {
        return;
    }
    let side = f32(task.size * task.samples);
    let weight = 1.0 / f32(task.samples * task.samples);
    var sum = 0.0;
    for (var j = 0u; j < task.samples; j++) {
        for (var i = 0u; i < task.samples; i++) {
            let uv = (vec2f(id.xy * task.samples + vec2u(i, j)) + 0.5) / side;
            sum += weight * min(max(relievo_recipe_height(uv, task.phase), 0.0), 1.0);
        }
    }
    textureStore(relievo_recipe_map, vec2i(id.xy), vec4f(max(sum, 0.0), 0.0, 0.0, 1.0));
}
