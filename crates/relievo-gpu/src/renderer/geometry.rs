//! All triangles of a scene in two buffers.

use std::ops::Range;

use relievo_march::ReliefMap;
use relievo_scene::{ColorSpace, Material, ReliefDepth, Scene, SurfaceMesh, SurfaceTechnique};
use wgpu::util::DeviceExt;

use super::layout::VertexLayout;
use super::shadow_views::Caster;
use crate::GpuError;

/// Largest number of triangles, as on the CPU.
const MAX_TRIANGLES: u64 = 16_000_000;

pub(crate) struct Geometry {
    pub(crate) vertices: wgpu::Buffer,
    pub(crate) indices: wgpu::Buffer,
    /// The indices of each object.
    pub(crate) objects: Vec<Range<u32>>,
    /// True if anything of it depends on how reliefs are drawn.
    pub(crate) moved: bool,
    /// Extents of what throws shadows.
    pub(crate) casters: Vec<Caster>,
}

impl Geometry {
    pub(crate) fn new(device: &wgpu::Device, scene: &Scene) -> Result<Self, GpuError> {
        let (mut vertices, mut indices) = (Vec::<VertexLayout>::new(), Vec::<u32>::new());
        let (mut objects, mut casters) = (Vec::new(), Vec::new());
        let heights: Vec<Option<ReliefMap>> =
            scene.materials.iter().map(|material| displacing_heights(material, scene.shading.color_space)).collect();
        for (number, object) in scene.objects.iter().enumerate() {
            let material = &scene.materials[object.material];
            let mut part = SurfaceMesh::in_scene_space(object);
            if let Some(heights) = &heights[object.material] {
                if material.relief.vertices_per_texel.is_some() {
                    return Err(GpuError::Scene(format!(
                        "object {number} has grid = \"texel\", which the CPU alone can trace: choose a number of vertices per \
                         side, or draw on the CPU"
                    )));
                }
                let grid = material.relief.grid;
                let count = indices.len() as u64 / 3 + part.displaced_count(grid, object.uv_repeat);
                if count > MAX_TRIANGLES {
                    return Err(GpuError::Scene(format!(
                        "object {number} has {count} triangles with grid = {grid}; at most {MAX_TRIANGLES} can be drawn: \
                         choose a smaller grid or a simpler mesh"
                    )));
                }
                let depth = ReliefDepth::new(material.height, object);
                let field = material.relief.field(heights, 0.0, material.wrap, object.uv_repeat);
                part = part.displaced(&field, &depth, material.midlevel, grid, object.uv_repeat);
            }
            let (offset, first) = (vertices.len() as u32, indices.len() as u32);
            indices.extend(part.triangles.iter().flatten().map(|i| i + offset));
            vertices.extend(part.vertices.iter().map(VertexLayout::from));
            objects.push(first..indices.len() as u32);
            let material = &scene.materials[object.material];
            casters.extend(Caster::of(&part, material.midlevel < 1.0));
        }
        // Buffers cannot be empty.
        if indices.is_empty() {
            vertices.push(bytemuck::Zeroable::zeroed());
            indices.push(0);
        }
        let buffer = |what: &str, contents: &[u8], usage| {
            let (bytes, max) = (contents.len() as u64, device.limits().max_buffer_size);
            if bytes > max {
                return Err(GpuError::BufferTooLarge { what: what.to_owned(), bytes, max });
            }
            Ok(device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(what), contents, usage }))
        };
        let vertices = buffer("the vertices", bytemuck::cast_slice(&vertices), wgpu::BufferUsages::VERTEX)?;
        let indices = buffer("the triangles", bytemuck::cast_slice(&indices), wgpu::BufferUsages::INDEX)?;
        let moved =
            heights.iter().any(Option::is_some) || scene.materials.iter().any(|material| material.midlevel < 1.0);
        Ok(Self { vertices, indices, objects, moved, casters })
    }
}

/// The heights of a material that moves vertices.
fn displacing_heights(material: &Material, space: ColorSpace) -> Option<ReliefMap> {
    (material.relief.technique == SurfaceTechnique::Displacement).then(|| material.heights(space)).flatten()
}
