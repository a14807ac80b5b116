//! The structures of the shaders as they lie in buffers.

use bytemuck::{Pod, Zeroable};
use relievo_march::{March, Ray, Record, ShadowRecord};

/// `Ray` of record.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct RayLayout {
    uv: [f32; 2],
    sweep: [f32; 2],
    cos: f32,
    pad: u32,
}

impl From<&Ray> for RayLayout {
    fn from(ray: &Ray) -> Self {
        Self { uv: ray.uv, sweep: ray.sweep, cos: ray.cos, pad: 0 }
    }
}

/// `March` of record.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct MarchLayout {
    min_layers: f32,
    max_layers: f32,
    refine_steps: u32,
    midlevel: f32,
    bounds: [f32; 4],
    bounded: u32,
    offset_limiting: u32,
    pad: [u32; 2],
}

impl From<&March> for MarchLayout {
    fn from(how: &March) -> Self {
        let bounds = how.bounds.map_or([0.0; 4], |b| [b.min[0], b.min[1], b.max[0], b.max[1]]);
        Self {
            min_layers: how.min_layers,
            max_layers: how.max_layers,
            refine_steps: how.refine_steps,
            midlevel: how.midlevel,
            bounds,
            bounded: how.bounds.is_some().into(),
            offset_limiting: how.offset_limiting.into(),
            pad: [0; 2],
        }
    }
}

/// `Job` of compute_job.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct JobLayout {
    pub(crate) how: MarchLayout,
    pub(crate) range: [f32; 2],
    pub(crate) lod: f32,
    pub(crate) last_level: i32,
    pub(crate) count: u32,
    pub(crate) step: f32,
    pub(crate) pad: [u32; 2],
}

/// `StoredRecord` of compute_march.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct RecordLayout {
    uv: [f32; 2],
    depth: f32,
    hit: u32,
    fetches: u32,
    iterations: u32,
}

impl From<&RecordLayout> for Record {
    fn from(stored: &RecordLayout) -> Self {
        Self {
            uv: stored.uv,
            depth: stored.depth,
            hit: stored.hit != 0,
            fetches: stored.fetches,
            iterations: stored.iterations,
        }
    }
}

/// `LightRay` of compute_shadow.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct LightRayLayout {
    pub(crate) light: RayLayout,
    pub(crate) depth: f32,
    pub(crate) pad: u32,
}

/// `ShadowRecord` of record.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct ShadowLayout {
    factor: f32,
    fetches: u32,
    iterations: u32,
}

impl From<&ShadowLayout> for ShadowRecord {
    fn from(stored: &ShadowLayout) -> Self {
        Self { factor: stored.factor, fetches: stored.fetches, iterations: stored.iterations }
    }
}
