//! The structures of the shaders as they lie in buffers.

use bytemuck::{Pod, Zeroable};
use relievo_march::{Cones, MarchOptions, Ray, Record, ShadowRecord, TileEntry};
use relievo_scene::Vertex;

/// `Ray` of record.wgsl.
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

/// `MarchOptions` of record.wgsl.
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
    cones: u32,
    pad: u32,
}

impl From<&MarchOptions> for MarchLayout {
    fn from(options: &MarchOptions) -> Self {
        let bounds = options.bounds.map_or([0.0; 4], |b| [b.min[0], b.min[1], b.max[0], b.max[1]]);
        Self {
            min_layers: options.min_layers,
            max_layers: options.max_layers,
            refine_steps: options.refine_steps,
            midlevel: options.midlevel,
            bounds,
            bounded: options.bounds.is_some().into(),
            offset_limiting: options.offset_limiting.into(),
            cones: u32::from(options.cones != Cones::Relaxed),
            pad: 0,
        }
    }
}

/// `Job` of compute_job.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct JobLayout {
    pub(crate) options: MarchLayout,
    pub(crate) range: [f32; 2],
    pub(crate) lod: f32,
    pub(crate) last_level: i32,
    pub(crate) count: u32,
    pub(crate) step: f32,
    pub(crate) tile: u32,
    pub(crate) pad: u32,
}

/// `TileEntry` of beam.wgsl.
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

/// `Task` of pyramid_build.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(crate) struct TaskLayout {
    pub(crate) first: [u32; 2],
    pub(crate) count: [u32; 2],
    pub(crate) blocks: [u32; 2],
    pub(crate) row: u32,
    pub(crate) below: u32,
    pub(crate) pitch: u32,
    pub(crate) mip: u32,
    pub(crate) levels: u32,
    pub(crate) sums: u32,
    pub(crate) coding: [f32; 2],
    pub(crate) pad: [u32; 2],
}

/// `Part` of halve.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(crate) struct PartLayout {
    pub(crate) first: [u32; 2],
    pub(crate) count: [u32; 2],
    pub(crate) pitch: u32,
    pub(crate) columns: u32,
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

/// `View` of scene.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct ViewLayout {
    pub(crate) eye: [f32; 3],
    pub(crate) near: f32,
    pub(crate) right: [f32; 3],
    pub(crate) light_count: u32,
    pub(crate) up: [f32; 3],
    pub(crate) ambient: f32,
    pub(crate) forward: [f32; 3],
    pub(crate) specular: f32,
    pub(crate) pixel_right: [f32; 3],
    pub(crate) shininess: f32,
    pub(crate) pixel_down: [f32; 3],
    pub(crate) turn: f32,
    pub(crate) shift: [f32; 2],
    pub(crate) parallel: u32,
    pub(crate) far: f32,
    pub(crate) pixel: [f32; 2],
    pub(crate) pad: [u32; 2],
}

/// `MAX_LIGHTS` of scene.wgsl.
pub(crate) const MAX_LIGHTS: usize = 64;

/// `Light` of light.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct LightLayout {
    pub(crate) position: [f32; 3],
    pub(crate) kind: u32,
    pub(crate) direction: [f32; 3],
    pub(crate) radius: f32,
    pub(crate) color: [f32; 3],
    pub(crate) cos_inner: f32,
    pub(crate) cos_outer: f32,
    pub(crate) pad: u32,
    pub(crate) map_shift: [f32; 2],
    pub(crate) map_eye: [f32; 3],
    pub(crate) map_near: f32,
    pub(crate) map_right: [f32; 3],
    pub(crate) map_far: f32,
    pub(crate) map_up: [f32; 3],
    pub(crate) map_layer: i32,
}

/// `RANGES` of surface.wgsl, times two.
pub(crate) const MAX_LEVELS: usize = 18;

/// `Surface` of surface.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct SurfaceLayout {
    pub(crate) options: MarchLayout,
    pub(crate) base_color: [f32; 3],
    pub(crate) roughness: f32,
    pub(crate) metallic: f32,
    pub(crate) depth: f32,
    pub(crate) depth_is_absolute: u32,
    pub(crate) last_level: i32,
    pub(crate) normal_decode: [f32; 2],
    pub(crate) height_step: f32,
    pub(crate) stretched: u32,
    pub(crate) levels: u32,
    pub(crate) number: u32,
    pub(crate) pad: [u32; 2],
    pub(crate) ranges: [[f32; 2]; MAX_LEVELS],
}

/// `Object` of surface.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct ObjectLayout {
    pub(crate) transposed: [[f32; 4]; 3],
    pub(crate) repeat: [f32; 2],
    pub(crate) number: u32,
    pub(crate) pad: u32,
}

/// `VertexIn` of vertex.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct VertexLayout {
    position: [f32; 3],
    normal: [f32; 3],
    tangent: [f32; 4],
    uv: [f32; 2],
    jacobian: [f32; 4],
}

impl VertexLayout {
    pub(crate) const ATTRIBUTES: [wgpu::VertexAttribute; 5] =
        wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32x2, 4 => Float32x4];
}

impl From<&Vertex> for VertexLayout {
    fn from(vertex: &Vertex) -> Self {
        Self {
            position: vertex.position.into(),
            normal: vertex.normal.into(),
            tangent: vertex.tangent.into(),
            uv: vertex.uv.into(),
            jacobian: vertex.jacobian.to_cols_array(),
        }
    }
}
