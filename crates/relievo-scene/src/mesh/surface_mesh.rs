use glam::{DVec2, Mat3, Vec2, Vec3, Vec4};
use relievo_map::Wrap;
use relievo_march::{Bounds, Corner};

use super::charts::{Chart, charts};
use super::{directions, far_uvs};
#[cfg(doc)]
use crate::Offset;
use crate::{HeightRange, Material, Object};

/// A corner of a triangle in scene space, with the data that a relief needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Position, scene units.
    pub position: Vec3,
    /// Normal: unit length on meshes; between their vertices as interpolated.
    pub normal: Vec3,
    /// Direction along which the relief rises: the normal, or one that all vertices at a position share (see [`Offset`]).
    pub direction: Vec3,
    /// Tangent: xyz along +u, w the handedness: bitangent (picture up) = w · (normal × tangent).
    pub tangent: Vec4,
    /// Texture coordinates, in texture repeats. Whole repeats may have been taken off, the same for a whole triangle.
    pub uv: Vec2,
    /// Length of one texture repeat along u on this vertex's chart, scene units: see [`Chart::repeat_length`].
    pub repeat_length: f32,
}

impl Vertex {
    /// Returns the corner of a shell over a triangle with this vertex.
    #[must_use]
    pub fn as_corner(&self) -> Corner {
        Corner { position: self.position.into(), normal: self.direction.into(), uv: self.uv.into() }
    }

    /// Interpolates a vertex between three others. Normals and tangents are interpolated as in drawing: not normalised.
    #[must_use]
    pub fn interpolate(corners: [&Self; 3], weights: [f32; 3]) -> Self {
        let sum3 = |f: &dyn Fn(&Self) -> Vec3| (0..3).map(|k| f(corners[k]) * weights[k]).sum::<Vec3>();
        let first = corners[0];
        Self {
            position: sum3(&|v| v.position),
            normal: sum3(&|v| v.normal),
            direction: sum3(&|v| v.direction),
            tangent: Vec4::from((sum3(&|v| v.tangent.truncate()), first.tangent.w)),
            uv: (0..3).map(|k| corners[k].uv * weights[k]).sum(),
            repeat_length: first.repeat_length,
        }
    }
}

/// The uv axes of a flat triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face {
    /// dP/du of one texture repeat, scene units.
    pub dp_du: Vec3,
    /// dP/dv of one texture repeat, scene units; down the picture.
    pub dp_dv: Vec3,
    /// Index of the face's chart in [`SurfaceMesh::charts`].
    pub chart: u32,
}

/// The triangles of an object in scene space, as all backends draw them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceMesh {
    /// The corners.
    pub vertices: Vec<Vertex>,
    /// Indices of corners, counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
    /// Indices into `faces`, one per triangle: the triangles of a displaced mesh share those of the triangle they were cut from.
    pub face_of: Vec<u32>,
    /// The flat triangles of the mesh that was given.
    pub faces: Vec<Face>,
    /// The parts that hang together in space, texture and normals.
    pub charts: Vec<Chart>,
}

impl SurfaceMesh {
    /// Transforms an object's mesh to scene space, with the uvs of its material's maps, and measures its uv axes and charts. Where
    /// texture coordinates lie many repeats from 0, whole repeats are taken off and long triangles cut, so that f32 can tell the
    /// texels apart.
    #[must_use]
    pub fn in_scene_space(object: &Object, material: &Material) -> Self {
        let transform = material.uv.after(object.uv_repeat);
        let moved = object.mesh.with_moved_uvs(&transform);
        let (mesh, repeat) = moved.as_ref().map_or((&*object.mesh, transform.scale), |mesh| (mesh, Vec2::ONE));
        let matrix = Mat3::from(object.transform.matrix3);
        let normals = matrix.inverse().transpose();
        // A mirroring transform turns the triangles and the tangent frames inside out.
        let mirrored = matrix.determinant() < 0.0;
        let handedness = if mirrored { -1.0 } else { 1.0 };
        let vertices: Vec<Vertex> = (0..mesh.positions.len())
            .map(|i| Vertex {
                position: object.transform.transform_point3(mesh.positions[i]),
                normal: (normals * mesh.normals[i]).normalize_or_zero(),
                direction: Vec3::ZERO,
                tangent: (matrix * mesh.tangents[i].truncate())
                    .normalize_or_zero()
                    .extend(mesh.tangents[i].w * handedness),
                uv: mesh.uvs[i] * repeat,
                repeat_length: 1.0,
            })
            .collect();
        let uvs: Vec<DVec2> = mesh.uvs.iter().map(|uv| uv.as_dvec2() * repeat.as_dvec2()).collect();
        let triangles: Vec<[u32; 3]> =
            mesh.triangles.iter().map(|&[a, b, c]| if mirrored { [a, c, b] } else { [a, b, c] }).collect();
        let mut this = Self { vertices, triangles, ..Self::default() };
        directions::set(&mut this.vertices, material.relief.offset);
        this.measure(&uvs);
        if let Some([u0, v0, u1, v1]) = material.uv_rect {
            for chart in &mut this.charts {
                (chart.min, chart.max, chart.is_rectangle) = (Vec2::new(u0, v0), Vec2::new(u1, v1), true);
            }
        }
        far_uvs::take_off(&mut this, uvs, material);
        this
    }

    /// Measures faces and charts; `uvs` are the vertices' texture coordinates before rounding.
    pub(super) fn measure(&mut self, uvs: &[DVec2]) {
        self.faces = self.triangles.iter().map(|&triangle| face(&self.vertices, uvs, triangle)).collect();
        self.face_of = (0..self.triangles.len() as u32).collect();
        let (charts, of_vertex) = charts(&self.vertices, &self.triangles, &mut self.faces);
        for (vertex, chart) in self.vertices.iter_mut().zip(of_vertex) {
            vertex.repeat_length = charts.get(chart as usize).map_or(1.0, |chart| chart.repeat_length);
        }
        self.charts = charts;
    }

    /// Returns the face of a triangle.
    #[must_use]
    pub fn face(&self, triangle: usize) -> &Face {
        &self.faces[self.face_of[triangle] as usize]
    }

    /// Returns the chart of a triangle.
    #[must_use]
    pub fn chart(&self, triangle: usize) -> &Chart {
        &self.charts[self.face(triangle).chart as usize]
    }

    /// Returns the texture range of all charts together.
    #[must_use]
    pub fn texture_range(&self) -> Bounds {
        let charts = self.charts.iter();
        let (min, max) = charts
            .fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(min, max), chart| (min.min(chart.min), max.max(chart.max)));
        Bounds { min: min.into(), max: max.into() }
    }

    /// Appends another mesh.
    pub fn append(&mut self, other: &mut Self) {
        let [vertices, faces, charts] = [self.vertices.len(), self.faces.len(), self.charts.len()].map(|n| n as u32);
        self.triangles.extend(other.triangles.drain(..).map(|corners| corners.map(|i| i + vertices)));
        self.face_of.extend(other.face_of.drain(..).map(|face| face + faces));
        self.faces.extend(other.faces.drain(..).map(|face| Face { chart: face.chart + charts, ..face }));
        self.vertices.append(&mut other.vertices);
        self.charts.append(&mut other.charts);
    }
}

/// The depth of a relief on an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReliefDepth {
    /// The material's range of heights.
    pub range: HeightRange,
    /// Linear part of the object's transform, transposed: maps scene normals to object space up to length.
    pub transposed: Mat3,
}

impl ReliefDepth {
    /// Makes the depth of a material with this range on this object.
    #[must_use]
    pub fn new(range: HeightRange, object: &Object) -> Self {
        Self { range, transposed: Mat3::from(object.transform.matrix3).transpose() }
    }

    /// Returns the distance between height 0 and height 1 at a vertex, in scene units.
    #[must_use]
    pub fn at(&self, vertex: &Vertex) -> f32 {
        match self.range {
            HeightRange::Scale(scale) => scale * vertex.repeat_length,
            // Planes move by 1/|M⁻ᵀ n| for a unit object normal n; with the scene normal N = M⁻ᵀn/|M⁻ᵀn| that is |MᵀN|.
            HeightRange::Depth(depth) => depth * (self.transposed * vertex.direction.normalize_or_zero()).length(),
        }
    }
}

/// Returns the uv axes of a triangle: dP/du and dP/dv of the affine map from texture to space that takes its corners' uvs to
/// their positions. Without a usable one: axes of unit length along the tangent frame.
fn face(vertices: &[Vertex], uvs: &[DVec2], triangle: [u32; 3]) -> Face {
    let [a, b, c] = triangle.map(|i| vertices[i as usize].position.as_dvec3());
    let [ta, tb, tc] = triangle.map(|i| uvs[i as usize]);
    let (e1, e2) = (b - a, c - a);
    let (d1, d2) = (tb - ta, tc - ta);
    let uv_area = d1.perp_dot(d2);
    let (du, dv) = ((e1 * d2.y - e2 * d1.y) / uv_area, (e2 * d1.x - e1 * d2.x) / uv_area);
    let (dp_du, dp_dv) = (du.as_vec3(), dv.as_vec3());
    if dp_du.is_finite() && dp_dv.is_finite() && dp_du.cross(dp_dv).length_squared() > 0.0 {
        return Face { dp_du, dp_dv, chart: 0 };
    }
    let vertex = &vertices[triangle[0] as usize];
    let tangent = vertex.tangent.truncate();
    Face { dp_du: tangent, dp_dv: -vertex.normal.cross(tangent) * vertex.tangent.w, chart: 0 }
}

impl Face {
    /// Returns true if the triangle's texture coordinates span an area, so that its axes are the texture's.
    pub(super) fn has_texture(uvs: [Vec2; 3]) -> bool {
        let area = (uvs[1] - uvs[0]).perp_dot(uvs[2] - uvs[0]);
        area != 0.0 && area.is_finite()
    }
}

/// Returns the whole repeats that may be taken off without changing what a map shows: any with `repeat`, even ones with
/// `mirror`, none with `clamp`.
pub(super) fn whole_repeats(wrap: Wrap, least: f64) -> f64 {
    match wrap {
        Wrap::Repeat => least.floor(),
        Wrap::Mirror => 2.0 * (least * 0.5).floor(),
        Wrap::Clamp => 0.0,
    }
}
