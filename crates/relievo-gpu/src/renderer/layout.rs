//! Structures of the renderer's shaders as they lie in buffers.

use bytemuck::{Pod, Zeroable};
use relievo_scene::Vertex;
use relievo_shader::MarchUniforms;

/// `RelievoCameraView` of scene.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct CameraViewLayout {
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
    pub(crate) rotation: f32,
    pub(crate) jitter: [f32; 2],
    pub(crate) parallel: u32,
    pub(crate) far: f32,
    pub(crate) pixel: [f32; 2],
    pub(crate) pad: [u32; 2],
}

/// `RELIEVO_MAX_LIGHTS` of scene.wgsl.
pub(crate) const MAX_LIGHTS: usize = 64;

/// `RelievoLight` of light.wgsl.
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
    pub(crate) map_window_offset: [f32; 2],
    pub(crate) map_eye: [f32; 3],
    pub(crate) map_near: f32,
    pub(crate) map_right: [f32; 3],
    pub(crate) map_far: f32,
    pub(crate) map_up: [f32; 3],
    pub(crate) map_layer: i32,
}

/// `RELIEVO_MAX_RANGE_PAIRS` of surface.wgsl, times two.
pub(crate) const MAX_LEVELS: usize = 18;

/// `RelievoSurface` of surface.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct SurfaceLayout {
    pub(crate) options: [u8; MarchUniforms::SIZE],
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
    pub(crate) normal_sign: f32,
    pub(crate) pad: u32,
    pub(crate) ranges: [[f32; 2]; MAX_LEVELS],
}

/// `RelievoObject` of surface.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct ObjectLayout {
    pub(crate) transposed: [[f32; 4]; 3],
    pub(crate) repeat: [f32; 2],
    pub(crate) number: u32,
    pub(crate) pad: u32,
    pub(crate) bounds: [f32; 4],
}

/// `RelievoVertexIn` of vertex.wgsl.
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
