//! All triangles of a scene in two buffers.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::{Arc, Weak};

use glam::{Affine3A, Vec2};
use relievo_map::GridId;
use relievo_march::{Bounds, Prism, ReliefMap};
use relievo_scene::{
    ColorSpace, Edge, HeightRange, MarchSpace, Material, Mesh, Object, Offset, ReliefDepth, Scene, Side, SurfaceMesh,
    SurfaceTechnique, UvTransform, Vertex,
};
use wgpu::util::DeviceExt;

use super::layout::{ShellLayout, VertexLayout};
use super::shadow_views::Caster;
use crate::GpuError;

/// Largest number of triangles, as on the CPU.
const MAX_TRIANGLES: u64 = 16_000_000;

/// An object's part of the buffers.
pub(crate) struct ObjectGeometry {
    pub(crate) space: MarchSpace,
    /// Indices of corners, or instances of shells.
    pub(crate) range: Range<u32>,
    /// True if any chart's texture range is not one tile.
    pub(crate) tiled: bool,
}

impl ObjectGeometry {
    /// Counts its triangles.
    pub(crate) fn triangles(&self) -> usize {
        match self.space {
            MarchSpace::Plane => self.range.len() / 3,
            MarchSpace::Shell => self.range.len(),
        }
    }
}

pub(crate) struct Geometry {
    pub(crate) vertices: wgpu::Buffer,
    pub(crate) indices: wgpu::Buffer,
    /// Triangles that are marched in shells, as instances.
    pub(crate) shells: wgpu::Buffer,
    pub(crate) objects: Vec<ObjectGeometry>,
    /// The backs of reliefs, each with the object whose back it is.
    pub(crate) backs: Vec<(usize, ObjectGeometry)>,
    /// What of each material it was made for.
    made_for: Vec<MadeFor>,
    /// The objects that it was made of: mesh, transform, repeats.
    made_of: Vec<(Weak<Mesh>, Affine3A, Vec2)>,
    /// Extents of what throws shadows.
    pub(crate) casters: Vec<Caster>,
}

impl Geometry {
    pub(crate) fn new(device: &wgpu::Device, scene: &Scene) -> Result<Self, GpuError> {
        let (mut vertices, mut indices) = (Vec::<VertexLayout>::new(), Vec::<u32>::new());
        let mut shells = Vec::<ShellLayout>::new();
        let (mut objects, mut backs, mut casters) = (Vec::new(), Vec::new(), Vec::new());
        let heights: Vec<Option<ReliefMap>> =
            scene.materials.iter().map(|material| displacing_heights(material, scene.shading.color_space)).collect();
        for (number, object) in scene.objects.iter().enumerate() {
            let material = &scene.materials[object.material];
            let mut part = SurfaceMesh::in_scene_space(object, material);
            let space = part.march_space(material);
            if let Some(heights) = &heights[object.material] {
                if material.relief.vertices_per_texel.is_some() {
                    return Err(GpuError::Scene(format!(
                        "object {number} has grid = \"texel\", which the CPU alone can trace: choose a number of vertices per \
                         side, or draw on the CPU"
                    )));
                }
                let grid = material.relief.grid;
                let uvs = material.uv.after(object.uv_repeat);
                let count = indices.len() as u64 / 3 + part.displaced_count(grid, &uvs);
                if count > MAX_TRIANGLES {
                    return Err(GpuError::Scene(format!(
                        "object {number} has {count} triangles with grid = {grid}; at most {MAX_TRIANGLES} can be drawn: \
                         choose a smaller grid or a simpler mesh"
                    )));
                }
                let depth = ReliefDepth::new(material.height, object);
                let field = material.relief.field(heights, 0.0, material.wrap, part.texture_range());
                part = part.displaced(&field, &depth, material.midlevel, grid, &uvs);
            }
            let tiled = part.charts.iter().any(|chart| chart.bounds() != Bounds::TILE);
            let mut push = |part: &SurfaceMesh, midlevel: f32| {
                let range = match space {
                    MarchSpace::Plane => append_polygons(part, &mut vertices, &mut indices),
                    MarchSpace::Shell => append_shells(part, (material, midlevel), object, &mut shells),
                };
                ObjectGeometry { space, range, tiled }
            };
            objects.push(push(&part, material.midlevel));
            if material.has_marched_back() {
                backs.push((number, push(&part.back(), Side::Back.midlevel(material.midlevel))));
            }
            casters.extend(Caster::of(&part, material.midlevel < 1.0 || space == MarchSpace::Shell));
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
        if shells.is_empty() {
            shells.push(bytemuck::Zeroable::zeroed());
        }
        let shells = buffer("the shells", bytemuck::cast_slice(&shells), wgpu::BufferUsages::VERTEX)?;
        let made_for = made_for(scene, &objects);
        let made_of = scene.objects.iter().map(|o| (Arc::downgrade(&o.mesh), o.transform, o.uv_repeat)).collect();
        Ok(Self { vertices, indices, shells, objects, backs, made_for, made_of, casters })
    }

    /// Returns true if the same geometry would be made for the scene as it is now.
    pub(crate) fn is_right_for(&self, scene: &Scene) -> bool {
        made_for(scene, &self.objects) == self.made_for && self.is_of_objects(scene)
    }

    /// Returns true if the scene has the objects that it was made of, where they were.
    fn is_of_objects(&self, scene: &Scene) -> bool {
        let same = |((mesh, transform, repeat), object): (&(Weak<Mesh>, Affine3A, Vec2), &Object)| {
            std::ptr::eq(mesh.as_ptr(), Arc::as_ptr(&object.mesh))
                && (*transform, *repeat) == (object.transform, object.uv_repeat)
        };
        self.made_of.len() == scene.objects.len() && self.made_of.iter().zip(&scene.objects).all(same)
    }
}

/// Settings of a material that geometry depends on.
#[derive(PartialEq)]
struct MadeFor {
    technique: SurfaceTechnique,
    edge: Edge,
    offset: Offset,
    is_raised: bool,
    /// Depth, midlevel and grid, where they move anything.
    moved: Option<(HeightRange, f32, u32)>,
    has_depth: bool,
    has_back: bool,
    uv: (UvTransform, Option<[f32; 4]>),
    /// The heights of displaced geometry.
    heights: Option<GridId>,
}

fn made_for(scene: &Scene, objects: &[ObjectGeometry]) -> Vec<MadeFor> {
    let made_for = |(number, material): (usize, &Material)| {
        let (HeightRange::Scale(depth) | HeightRange::Depth(depth)) = material.height;
        let relief = &material.relief;
        let mut spaces = objects.iter().zip(&scene.objects).filter(|(_, object)| object.material == number);
        let moves = relief.technique == SurfaceTechnique::Displacement
            || spaces.any(|(object, _)| object.space == MarchSpace::Shell);
        MadeFor {
            technique: relief.technique,
            edge: relief.edge,
            offset: relief.offset,
            is_raised: material.midlevel < 1.0,
            moved: moves.then_some((material.height, material.midlevel, relief.grid)),
            has_depth: depth > 0.0,
            has_back: material.has_marched_back(),
            uv: (material.uv, material.uv_rect),
            heights: (relief.technique == SurfaceTechnique::Displacement).then(|| material.maps.ids()[2]).flatten(),
        }
    };
    scene.materials.iter().enumerate().map(made_for).collect()
}

/// Appends the triangles of a mesh as polygons; returns the range of their indices. Vertices belong to one face each.
fn append_polygons(mesh: &SurfaceMesh, vertices: &mut Vec<VertexLayout>, indices: &mut Vec<u32>) -> Range<u32> {
    let first = indices.len() as u32;
    let mut known: HashMap<(u32, u32), u32> = HashMap::new();
    for (triangle, &face) in mesh.triangles.iter().zip(&mesh.face_of) {
        let (axes, chart) = (&mesh.faces[face as usize], &mesh.charts[mesh.faces[face as usize].chart as usize]);
        for &corner in triangle {
            let index = *known.entry((corner, face)).or_insert_with(|| {
                vertices.push(VertexLayout::new(&mesh.vertices[corner as usize], axes, chart));
                vertices.len() as u32 - 1
            });
            indices.push(index);
        }
    }
    first..indices.len() as u32
}

/// Appends the triangles of a mesh with shells over them; returns the range of their instances.
fn append_shells(
    mesh: &SurfaceMesh,
    (material, midlevel): (&Material, f32),
    object: &Object,
    shells: &mut Vec<ShellLayout>,
) -> Range<u32> {
    let first = shells.len() as u32;
    let depth = ReliefDepth::new(material.height, object);
    for &triangle in &mesh.triangles {
        let corners = triangle.map(|i| &mesh.vertices[i as usize]);
        let prism = Prism::new(corners.map(Vertex::as_corner), depth.at(corners[0]), midlevel);
        // Heights that the caller changes later lie in the hull too.
        shells.push(ShellLayout::new(corners, prism.offsets([0.0, 1.0]).map(|offset| offset as f32)));
    }
    first..shells.len() as u32
}

/// The heights of a material that moves vertices.
fn displacing_heights(material: &Material, space: ColorSpace) -> Option<ReliefMap> {
    (material.relief.technique == SurfaceTechnique::Displacement).then(|| material.heights(space)).flatten()
}
