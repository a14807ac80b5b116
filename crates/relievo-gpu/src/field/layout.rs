//! Structures of the pyramid and mip shaders as they lie in buffers.

use bytemuck::{Pod, Zeroable};

/// `RelievoPyramidTask` of pyramid_build.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(crate) struct PyramidTaskLayout {
    pub(crate) first: [u32; 2],
    pub(crate) count: [u32; 2],
    pub(crate) blocks: [u32; 2],
    pub(crate) row: u32,
    pub(crate) below: u32,
    pub(crate) pitch: u32,
    pub(crate) mip: u32,
    pub(crate) levels: u32,
    pub(crate) sums: u32,
    pub(crate) quantization: [f32; 2],
    pub(crate) pad: [u32; 2],
}

/// `RelievoMipTask` of halve.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(crate) struct MipTaskLayout {
    pub(crate) first: [u32; 2],
    pub(crate) count: [u32; 2],
    pub(crate) pitch: u32,
    pub(crate) columns: u32,
    pub(crate) pad: [u32; 2],
}
