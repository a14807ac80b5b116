//! All triangles of a scene in two buffers.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::{Arc, Weak};

use glam::{Affine3A, Vec2};
use relievo_map::GridId;
use relievo_march::{Bounds, ReliefMap, Shadow};
use relievo_scene::{
    ColorSpace, Edge, HeightRange, MarchSpace, Material, Mesh, Object, Offset, ReliefDepth, Scene, Side, SurfaceMesh,
    SurfaceTechnique, UvTransform,
};
use wgpu::util::DeviceExt;

use super::layout::VertexLayout;
use super::permutation::{DrawnGeometry, Pass};
use super::shadow_views::Caster;
use super::shells::{NearPlane, ShellObject, Shells};
use crate::GpuError;

/// An object's part of the buffers.
pub(crate) struct ObjectGeometry {
    pub(crate) part: Part,
    /// True if any chart's texture range is not one tile.
    pub(crate) tiled: bool,
}

/// Triangles of an object, by how they are marched.
pub(crate) enum Part {
    /// Indices of corners.
    Polygons(Range<u32>),
    Shells(ShellObject),
}

impl ObjectGeometry {
    /// Counts its triangles.
    pub(crate) fn triangles(&self) -> usize {
        match &self.part {
            Part::Polygons(range) => range.len() / 3,
            Part::Shells(shells) => shells.range.len(),
        }
    }

    /// Returns the geometry that it is drawn by, as of [`Geometry::see_from`].
    pub(crate) fn drawn_geometry(&self, pass: Pass) -> DrawnGeometry {
        match &self.part {
            Part::Polygons(_) => DrawnGeometry::Polygons,
            // Lights may stand anywhere.
            Part::Shells(shells) if shells.is_walked && pass != Pass::Caster => DrawnGeometry::Lids,
            Part::Shells(_) => DrawnGeometry::Hulls,
        }
    }

    pub(crate) fn space(&self) -> MarchSpace {
        match self.part {
            Part::Polygons(_) => MarchSpace::Plane,
            Part::Shells(_) => MarchSpace::Shell,
        }
    }
}

pub(crate) struct Geometry {
    pub(crate) vertices: wgpu::Buffer,
    pub(crate) indices: wgpu::Buffer,
    /// Triangles that are marched in shells, as instances.
    pub(crate) shells: wgpu::Buffer,
    /// All that is known of them.
    pub(crate) shell_texture: wgpu::TextureView,
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
    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue, scene: &Scene) -> Result<Self, GpuError> {
        let (mut vertices, mut indices) = (Vec::<VertexLayout>::new(), Vec::<u32>::new());
        let mut shells = Shells::default();
        let shadowed_mist = has_shadowed_mist(scene);
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
                if count > SurfaceMesh::MAX_TRIANGLES {
                    let max = SurfaceMesh::MAX_TRIANGLES;
                    return Err(GpuError::Scene(format!(
                        "object {number} has {count} triangles with grid = {grid}; at most {max} can be drawn: \
                         choose a smaller grid or a simpler mesh"
                    )));
                }
                let depth = ReliefDepth::new(material.height, object);
                let field = material.relief.field(heights, 0.0, material.wrap, part.texture_range());
                part = part.displaced(&field, &depth, material.midlevel, grid, &uvs);
            }
            let tiled = part.charts.iter().any(|chart| chart.bounds() != Bounds::TILE);
            let mut push = |part: &SurfaceMesh, midlevel: f32| {
                let depth = ReliefDepth::new(material.height, object);
                let part = match space {
                    MarchSpace::Plane => Part::Polygons(append_polygons(part, &mut vertices, &mut indices)),
                    MarchSpace::Shell => Part::Shells(shells.append(part, &depth, midlevel)),
                };
                ObjectGeometry { part, tiled }
            };
            objects.push(push(&part, material.midlevel));
            if material.has_marched_back() {
                backs.push((number, push(&part.back(), Side::Back.midlevel(material.midlevel))));
            }
            // Mist dims lights, it does not hide them.
            let caster = Caster::of(&part, material.midlevel < 1.0 || space == MarchSpace::Shell);
            let caster = caster.filter(|_| !material.is_mist());
            let depth = ReliefDepth::new(material.height, object);
            let in_mist = |caster: Caster| caster.in_mist(&part, &depth, material.midlevel);
            casters.extend(if shadowed_mist { caster.map(in_mist) } else { caster });
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
        let shell_texture = shells.texture(device, queue)?;
        let shells = buffer("the shells", bytemuck::cast_slice(shells.instances()), wgpu::BufferUsages::VERTEX)?;
        let made_for = made_for(scene, &objects);
        let made_of = scene.objects.iter().map(|o| (Arc::downgrade(&o.mesh), o.transform, o.uv_repeat)).collect();
        Ok(Self { vertices, indices, shells, shell_texture, objects, backs, made_for, made_of, casters })
    }

    /// Chooses how shells are drawn for a camera.
    pub(crate) fn see_from(&mut self, eye: &NearPlane) {
        for object in self.objects.iter_mut().chain(self.backs.iter_mut().map(|back| &mut back.1)) {
            if let Part::Shells(shells) = &mut object.part {
                shells.is_walked = shells.is_walked_from(eye);
            }
        }
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
    let in_mist = has_shadowed_mist(scene);
    let made_for = |(number, material): (usize, &Material)| {
        let (HeightRange::Scale(depth) | HeightRange::Depth(depth)) = material.height;
        let relief = &material.relief;
        let mut spaces = objects.iter().zip(&scene.objects).filter(|(_, object)| object.material == number);
        let moves = relief.technique == SurfaceTechnique::Displacement
            || in_mist
            || spaces.any(|(object, _)| object.space() == MarchSpace::Shell);
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

/// Returns true if surfaces throw shadows into mist.
fn has_shadowed_mist(scene: &Scene) -> bool {
    let mut used = scene.objects.iter().map(|object| &scene.materials[object.material]);
    used.any(|material| material.is_mist() && material.relief.shadow != Shadow::None)
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

/// The heights of a material that moves vertices.
fn displacing_heights(material: &Material, space: ColorSpace) -> Option<ReliefMap> {
    (material.relief.technique == SurfaceTechnique::Displacement).then(|| material.heights(space)).flatten()
}
