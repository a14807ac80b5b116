//! The self-shadow as a compute kernel: one point and light of a buffer per invocation.
//!
//! Gives the entry point `shadow_rays`; declares its bindings.
//! #import compute_job
//! #import shadow

struct LightRay {
    light: Ray,
    depth: f32,
}

@group(0) @binding(2) var<storage, read> lights: array<LightRay>;
@group(0) @binding(3) var<storage, read_write> factors: array<ShadowRecord>;

@compute @workgroup_size(64)
fn shadow_rays(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= job.count {
        return;
    }
    factors[id.x] = relief_shadow(job_field(), lights[id.x].light, lights[id.x].depth, job.how);
}
