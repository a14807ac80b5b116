use glam::{Mat2, Mat3, Vec2, Vec3, Vec4};

use crate::{HeightRange, Material, Object};

/// A corner of a triangle in scene space, with the data that a relief needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Position, scene units.
    pub position: Vec3,
    /// Normal: unit length on meshes; between their vertices as interpolated.
    pub normal: Vec3,
    /// Tangent: xyz along +u, w the handedness: bitangent (picture up) = w · (normal × tangent).
    pub tangent: Vec4,
    /// Texture coordinates, in texture repeats.
    pub uv: Vec2,
    /// dP/du and dP/dv of one texture repeat as columns, in the (tangent, bitangent) frame, scene units.
    pub jacobian: Mat2,
}

impl Vertex {
    /// Interpolates a vertex between three others. Normals and tangents are interpolated as in drawing: not normalised.
    #[must_use]
    pub fn interpolate(corners: [&Self; 3], weights: [f32; 3]) -> Self {
        let sum3 = |f: &dyn Fn(&Self) -> Vec3| (0..3).map(|k| f(corners[k]) * weights[k]).sum::<Vec3>();
        let [a, b, c] = corners;
        Self {
            position: sum3(&|v| v.position),
            normal: sum3(&|v| v.normal),
            tangent: Vec4::from((sum3(&|v| v.tangent.truncate()), a.tangent.w)),
            uv: (0..3).map(|k| corners[k].uv * weights[k]).sum(),
            jacobian: a.jacobian * weights[0] + b.jacobian * weights[1] + c.jacobian * weights[2],
        }
    }
}

/// The triangles of an object in scene space, as all backends draw them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceMesh {
    /// The corners.
    pub vertices: Vec<Vertex>,
    /// Indices of corners, counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
}

impl SurfaceMesh {
    /// Transforms an object's mesh to scene space, with the uvs of its material's maps, and measures its uv axes.
    #[must_use]
    pub fn in_scene_space(object: &Object, material: &Material) -> Self {
        let uvs = material.uv.after(object.uv_repeat);
        let moved = object.mesh.with_moved_uvs(&uvs);
        let (mesh, repeat) = moved.as_ref().map_or((&*object.mesh, uvs.scale), |mesh| (mesh, Vec2::ONE));
        let matrix = Mat3::from(object.transform.matrix3);
        let normals = matrix.inverse().transpose();
        // A mirroring transform turns the triangles and the tangent frames inside out.
        let mirrored = matrix.determinant() < 0.0;
        let handedness = if mirrored { -1.0 } else { 1.0 };
        let mut vertices: Vec<Vertex> = (0..mesh.positions.len())
            .map(|i| Vertex {
                position: object.transform.transform_point3(mesh.positions[i]),
                normal: (normals * mesh.normals[i]).normalize_or_zero(),
                tangent: (matrix * mesh.tangents[i].truncate())
                    .normalize_or_zero()
                    .extend(mesh.tangents[i].w * handedness),
                uv: mesh.uvs[i] * repeat,
                jacobian: Mat2::ZERO,
            })
            .collect();
        let triangles: Vec<[u32; 3]> =
            mesh.triangles.iter().map(|&[a, b, c]| if mirrored { [a, c, b] } else { [a, b, c] }).collect();
        measure_uv_axes(&mut vertices, &triangles);
        Self { vertices, triangles }
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
            HeightRange::Scale(scale) => scale * vertex.jacobian.x_axis.length(),
            // Planes move by 1/|M⁻ᵀ n| for a unit object normal n; with the scene normal N = M⁻ᵀn/|M⁻ᵀn| that is |MᵀN|.
            HeightRange::Depth(depth) => depth * (self.transposed * vertex.normal.normalize_or_zero()).length(),
        }
    }
}

/// Gives every vertex the mean of dP/du and dP/dv over its triangles, weighted by area, so that lengths vary smoothly over
/// a curved mesh.
fn measure_uv_axes(vertices: &mut [Vertex], triangles: &[[u32; 3]]) {
    let mut sums = vec![(Vec3::ZERO, Vec3::ZERO, 0.0f32); vertices.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|i| &vertices[i as usize]);
        let (e1, e2) = (b.position - a.position, c.position - a.position);
        let (d1, d2) = (b.uv - a.uv, c.uv - a.uv);
        let uv_area = d1.perp_dot(d2);
        let area = e1.cross(e2).length();
        let (du, dv) = ((e1 * d2.y - e2 * d1.y) / uv_area, (e2 * d1.x - e1 * d2.x) / uv_area);
        if !(du.is_finite() && dv.is_finite() && area > 0.0) {
            continue;
        }
        for &i in triangle {
            let (sum_u, sum_v, weight) = &mut sums[i as usize];
            *sum_u += du * area;
            *sum_v += dv * area;
            *weight += area;
        }
    }
    for (vertex, (du, dv, weight)) in vertices.iter_mut().zip(sums) {
        let normal = vertex.normal;
        let tangent = vertex.tangent.truncate();
        let bitangent = normal.cross(tangent) * vertex.tangent.w;
        let columns = [du, dv].map(|d| Vec2::new(d.dot(tangent), d.dot(bitangent)) / weight);
        let jacobian = Mat2::from_cols(columns[0], columns[1]);
        // Without usable texture coordinates there is no relief to scale: any invertible frame will do.
        vertex.jacobian = if jacobian.is_finite() && jacobian.determinant() != 0.0 {
            jacobian
        } else {
            Mat2::from_diagonal(Vec2::new(1.0, -1.0))
        };
    }
}
