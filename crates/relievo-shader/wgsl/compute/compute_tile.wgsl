//! The coarse pass before a march as a compute kernel: one tile of rays that follow each other in the buffer per invocation.
//!
//! Gives the entry point `tile_entries`; declares its bindings.
//! #import compute_job
//! #import beam

@group(0) @binding(2) var<storage, read> rays: array<Ray>;
@group(0) @binding(3) var<storage, read_write> entries: array<TileEntry>;

@compute @workgroup_size(64)
fn tile_entries(@builtin(global_invocation_id) id: vec3u) {
    let first = id.x * job.tile;
    if first >= job.count {
        return;
    }
    let field = job_field();
    var beam = beam_empty();
    for (var k = first; k < min(first + job.tile, job.count); k++) {
        beam = beam_with(beam, rays[k], field, job.how);
    }
    entries[id.x] = beam_entry(field, beam);
}
