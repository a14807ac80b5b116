//! The coarse pass before a march as a compute kernel: one tile of rays that follow each other in the buffer per invocation.
//!
//! Gives the entry point `relievo_tile_entries`; declares its bindings.
//! #import compute_job
//! #import beam

@group(0) @binding(2) var<storage, read> relievo_rays: array<RelievoRay>;
@group(0) @binding(3) var<storage, read_write> relievo_entries: array<RelievoTileEntry>;

@compute @workgroup_size(64)
fn relievo_tile_entries(@builtin(global_invocation_id) id: vec3u) {
    let first = id.x * relievo_job.tile;
    if first >= relievo_job.count {
        return;
    }
    let field = relievo_job_field();
    var beam = relievo_beam_empty();
    for (var k = first; k < min(first + relievo_job.tile, relievo_job.count); k++) {
        beam = relievo_beam_with(beam, relievo_rays[k], field, relievo_job.options);
    }
    relievo_entries[id.x] = relievo_beam_entry(field, beam);
}
