use glam::{DVec2, Mat3, Vec2, Vec3};

use super::charts::charts;
use super::surface_mesh::SurfaceMesh;
use super::vertex::{Face, Vertex};
use super::{directions, far_uvs};
use crate::{Material, Object};

impl SurfaceMesh {
    /// Transforms an object's mesh to scene space, with the uvs of its material's maps, and measures its uv axes and charts.
    /// Where texture coordinates lie many repeats from 0, whole repeats are taken off and long triangles cut, so that f32
    /// can tell the texels apart.
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
