//! What the compute kernels march through: the height map and the settings.
//!
//! Gives relievo_job, relievo_job_field; declares relievo_heights, relievo_pyramid, relievo_cones.
//! #import record
//! #import height

struct RelievoMarchJob {
    options: RelievoMarchOptions,
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

@group(0) @binding(0) var relievo_heights: texture_2d<f32>;
@group(0) @binding(1) var<uniform> relievo_job: RelievoMarchJob;
@group(0) @binding(4) var relievo_pyramid: texture_2d<u32>;
@group(0) @binding(7) var relievo_cones: texture_2d<u32>;

fn relievo_job_field() -> RelievoHeightField {
    var field = relievo_height_field(relievo_job.lod, relievo_job.last_level);
    field.range = relievo_job.range;
    field.step = relievo_job.step;
    return field;
}
