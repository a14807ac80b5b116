//! The march as a compute kernel: one ray of a buffer per invocation.
//!
//! Gives the entry point `march_rays`; declares its bindings.
//! #import compute_job
//! #import march

// As in host memory: WGSL's bool has no layout.
struct StoredRecord {
    uv: vec2f,
    depth: f32,
    hit: u32,
    fetches: u32,
    iterations: u32,
}

@group(0) @binding(2) var<storage, read> rays: array<Ray>;
@group(0) @binding(3) var<storage, read_write> records: array<StoredRecord>;
// Of each tile: how deep all its rays stay above the surface, and what it cost to know.
@group(0) @binding(5) var<storage, read> entries: array<vec2f>;

@compute @workgroup_size(64)
fn march_rays(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= job.count {
        return;
    }
    var entry = 0.0;
    if job.tile > 0u {
        entry = entries[id.x / job.tile].x;
    }
    let record = relief_march_from(job_field(), rays[id.x], job.how, entry);
    records[id.x] = StoredRecord(
        record.uv, record.depth, select(0u, 1u, record.hit), record.fetches, record.iterations);
}
