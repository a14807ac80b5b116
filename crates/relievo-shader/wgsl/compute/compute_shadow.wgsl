//! The self-shadow as a compute kernel: one point and light of a buffer per invocation.
//!
//! Gives the entry point `relievo_shadow_rays`; declares its bindings.
//! #import compute_job
//! #import shadow

struct RelievoLightRay {
    light: RelievoRay,
    depth: f32,
}

@group(0) @binding(2) var<storage, read> relievo_lights: array<RelievoLightRay>;
@group(0) @binding(3) var<storage, read_write> relievo_factors: array<RelievoShadowRecord>;

@compute @workgroup_size(64)
fn relievo_shadow_rays(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= relievo_job.count {
        return;
    }
    let start = relievo_lights[id.x];
    relievo_factors[id.x] = relievo_shadow(relievo_job_field(), start.light, start.depth, relievo_job.options);
}
