//! What the compute kernels march through: the height map and the settings.
//!
//! Gives job, job_field; declares relief_heights, relief_pyramid, relief_cones.
//! #import record
//! #import height

struct Job {
    how: March,
    // Of the level whose cells are marched.
    range: vec2f,
    lod: f32,
    last_level: i32,
    // Rays in the buffer.
    count: u32,
    // The map's smallest difference in height.
    step: f32,
    // Rays that share an entry; 0: none do.
    tile: u32,
}

@group(0) @binding(0) var relief_heights: texture_2d<f32>;
@group(0) @binding(1) var<uniform> job: Job;
@group(0) @binding(4) var relief_pyramid: texture_2d<u32>;
@group(0) @binding(7) var relief_cones: texture_2d<u32>;

fn job_field() -> Field {
    var field = height_field(job.lod, job.last_level);
    field.range = job.range;
    field.step = job.step;
    return field;
}
