//! Structures of the renderer's shaders as they lie in buffers.

use bytemuck::{Pod, Zeroable};
use relievo_scene::{Chart, Face, Vertex};
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
    pub(crate) skipped: f32,
    pub(crate) pad: u32,
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
    pub(crate) height_step: f32,
    pub(crate) stretched: u32,
    pub(crate) levels: u32,
    pub(crate) number: u32,
    pub(crate) normal_sign: f32,
    pub(crate) pad: [u32; 3],
    pub(crate) ranges: [[f32; 2]; MAX_LEVELS],
}

/// `RelievoObject` of surface.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct ObjectLayout {
    pub(crate) transposed: [[f32; 4]; 3],
    pub(crate) number: u32,
    pub(crate) pad: [u32; 3],
}

/// `RelievoVertexIn` of vertex.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct VertexLayout {
    position: [f32; 3],
    normal: [f32; 3],
    tangent: [f32; 4],
    uv: [f32; 2],
    dp_du: [f32; 3],
    dp_dv: [f32; 3],
    range: [f32; 4],
    repeat_length: f32,
    direction: [f32; 3],
}

impl VertexLayout {
    pub(crate) const ATTRIBUTES: [wgpu::VertexAttribute; 9] = wgpu::vertex_attr_array![
        0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32x2, 4 => Float32x3, 5 => Float32x3, 6 => Float32x4,
        7 => Float32, 8 => Float32x3
    ];

    /// Lays out a corner of a face of this chart.
    pub(crate) fn new(vertex: &Vertex, face: &Face, chart: &Chart) -> Self {
        Self {
            position: vertex.position.into(),
            normal: vertex.normal.into(),
            tangent: vertex.tangent.into(),
            uv: vertex.uv.into(),
            dp_du: face.dp_du.into(),
            dp_dv: face.dp_dv.into(),
            range: [chart.min.x, chart.min.y, chart.max.x, chart.max.y],
            repeat_length: vertex.repeat_length,
            direction: vertex.direction.into(),
        }
    }
}

/// `RelievoVertexIn` of shell_vertex.wgsl: a triangle with a shell over it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct ShellInstance {
    /// Its place in the texture of shells.
    pub(crate) triangle: u32,
    /// Offsets between which it is drawn.
    pub(crate) floor: f32,
    pub(crate) lid: f32,
    /// Diagonals of walls that are folded the other way, and from bit 3 on edges without a neighbor.
    pub(crate) walls: u32,
}

impl ShellInstance {
    /// Vertices of the lid.
    pub(crate) const LID: std::ops::Range<u32> = 0..3;
    /// Vertices of the lid and the walls.
    pub(crate) const LID_AND_WALLS: std::ops::Range<u32> = 0..21;
    /// Vertices of the hull: eight triangles.
    pub(crate) const HULL: std::ops::Range<u32> = 0..24;

    pub(crate) const ATTRIBUTES: [wgpu::VertexAttribute; 4] =
        wgpu::vertex_attr_array![0 => Uint32, 1 => Float32, 2 => Float32, 3 => Uint32];
}

/// A triangle in the texture of shells; see shells.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct ShellLayout {
    positions: [[f32; 4]; 3],
    directions: [[f32; 4]; 3],
    neighbors: [u32; 3],
    depth: f32,
    normals: [[f32; 4]; 3],
    tangents: [[f32; 4]; 3],
}

impl ShellLayout {
    /// Texels of the texture that it takes, side by side.
    pub(crate) const TEXELS: u32 = 13;

    /// Lays out a triangle; `depth` is the distance between height 0 and 1, scene units.
    pub(crate) fn new(corners: [&Vertex; 3], neighbors: [u32; 3], depth: f32) -> Self {
        Self {
            positions: corners.map(|corner| corner.position.extend(corner.uv.x).into()),
            directions: corners.map(|corner| corner.direction.extend(corner.uv.y).into()),
            neighbors,
            depth,
            normals: corners.map(|corner| corner.normal.extend(0.0).into()),
            tangents: corners.map(|corner| corner.tangent.into()),
        }
    }
}
