//! The march as a compute kernel: one ray of a buffer per invocation.
//!
//! Gives the entry point `relievo_march_rays`; declares its bindings.
//! #import compute_job
//! #import march

// As in host memory: WGSL's bool has no layout.
struct RelievoStoredRecord {
    uv: vec2f,
    depth: f32,
    hit: u32,
    fetches: u32,
    iterations: u32,
}

@group(0) @binding(2) var<storage, read> relievo_rays: array<RelievoRay>;
@group(0) @binding(3) var<storage, read_write> relievo_records: array<RelievoStoredRecord>;
// Of each tile: how deep all its rays stay above the surface, and what it cost to know.
@group(0) @binding(5) var<storage, read> relievo_entries: array<vec2f>;

@compute @workgroup_size(64)
fn relievo_march_rays(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= relievo_job.count {
        return;
    }
    var entry = 0.0;
    if relievo_job.tile > 0u {
        entry = relievo_entries[id.x / relievo_job.tile].x;
    }
    let record = relievo_march_from(relievo_job_field(), relievo_rays[id.x], relievo_job.options, entry);
    relievo_records[id.x] = RelievoStoredRecord(
        record.uv, record.depth, select(0u, 1u, record.hit), record.fetches, record.iterations);
}
