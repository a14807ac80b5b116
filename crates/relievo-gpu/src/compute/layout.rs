//! Structures of the compute shaders as they lie in buffers.

use bytemuck::{Pod, Zeroable};
use relievo_march::{Ray, Record, ShadowRecord, TileEntry};
use relievo_shader::MarchUniforms;

/// `RelievoRay` of record.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct RayLayout {
    uv: [f32; 2],
    uv_delta: [f32; 2],
    cos: f32,
    pad: u32,
}

impl From<&Ray> for RayLayout {
    fn from(ray: &Ray) -> Self {
        Self { uv: ray.uv, uv_delta: ray.uv_delta, cos: ray.cos, pad: 0 }
    }
}

/// `RelievoMarchJob` of compute_job.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct MarchJobLayout {
    pub(crate) options: [u8; MarchUniforms::SIZE],
    pub(crate) range: [f32; 2],
    pub(crate) lod: f32,
    pub(crate) last_level: i32,
    pub(crate) count: u32,
    pub(crate) step: f32,
    pub(crate) tile: u32,
    pub(crate) pad: u32,
}

/// `RelievoTileEntry` of beam.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct TileEntryLayout {
    depth: f32,
    fetches: u32,
}

impl From<&TileEntryLayout> for TileEntry {
    fn from(stored: &TileEntryLayout) -> Self {
        Self { depth: stored.depth, fetches: stored.fetches }
    }
}

/// `RelievoStoredRecord` of compute_march.wgsl.
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

/// `RelievoLightRay` of compute_shadow.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct LightRayLayout {
    pub(crate) light: RayLayout,
    pub(crate) depth: f32,
    pub(crate) pad: u32,
}

/// `RelievoShadowRecord` of record.wgsl.
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
