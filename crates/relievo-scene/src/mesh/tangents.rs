//! MikkTSpace tangents (Mikkelsen 2008), per corner, with the bitangent pointing up in the picture.

use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use glam::{Mat2, Vec3, Vec4};

use super::indexed_mesh::Mesh;

/// Replaces the tangents of a mesh whose shape is already checked by those along its uvs times `to_map`; splits vertices whose
/// corners differ.
pub(super) fn generate(mesh: &mut Mesh, to_map: Mat2) {
    let mut corners = Corners { mesh, to_map, tangents: vec![Vec4::W; mesh.triangles.len() * 3] };
    // The error type has no values in this version; should a later one fail, every corner gets some tangent below.
    let _ = generate_tangents(&mut corners);
    let mut tangents = corners.tangents;
    for (tangent, &vertex) in tangents.iter_mut().zip(mesh.triangles.as_flattened()) {
        *tangent = sound(*tangent, mesh.normals[vertex as usize]);
    }
    split(mesh, &tangents);
}

/// Returns a tangent of unit length that is not along the normal, with w = ±1.
pub(super) fn sound(tangent: Vec4, normal: Vec3) -> Vec4 {
    let w = if tangent.w < 0.0 { -1.0 } else { 1.0 };
    let direction = tangent.truncate().as_dvec3().normalize_or_zero().as_vec3();
    // Also false for NaN, which a degenerate triangle may leave behind.
    let usable = direction.reject_from_normalized(normal).length() > 1e-3;
    (if usable { direction } else { normal.any_orthonormal_vector() }).extend(w)
}

struct Corners<'a> {
    mesh: &'a Mesh,
    to_map: Mat2,
    tangents: Vec<Vec4>,
}

impl Corners<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.mesh.triangles[face][corner] as usize
    }
}

impl Geometry for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.mesh.triangles.len()
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.positions[self.vertex(face, corner)].to_array()
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.normals[self.vertex(face, corner)].to_array()
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        let uv = self.to_map * self.mesh.uvs[self.vertex(face, corner)];
        // MikkTSpace's bitangent runs along increasing t. Ours runs up in the picture, against v.
        [uv.x, -uv.y]
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        // None for a degenerate triangle without neighbours.
        if let Some(space) = space {
            self.tangents[face * 3 + corner] = Vec4::from_array(space.tangent_encoded());
        }
    }
}

/// Gives every vertex one tangent: the first corner keeps the vertex, corners with another tangent get a copy of it.
fn split(mesh: &mut Mesh, corner_tangents: &[Vec4]) {
    const NONE: u32 = u32::MAX;
    let originals = mesh.positions.len();
    let mut taken = vec![false; originals];
    // Vertices that share everything but the tangent, as linked lists.
    let mut next = vec![NONE; originals];
    let Mesh { positions, normals, uvs, tangents, triangles } = mesh;
    for (triangle, corner_tangents) in triangles.iter_mut().zip(corner_tangents.chunks_exact(3)) {
        for (corner, &tangent) in triangle.iter_mut().zip(corner_tangents) {
            let mut vertex = *corner as usize;
            if !taken[vertex] {
                taken[vertex] = true;
                tangents[vertex] = tangent;
                continue;
            }
            while tangents[vertex] != tangent && next[vertex] != NONE {
                vertex = next[vertex] as usize;
            }
            if tangents[vertex] != tangent {
                // At most three vertices per triangle: far below u32::MAX.
                next[vertex] = positions.len() as u32;
                let source = *corner as usize;
                vertex = positions.len();
                positions.push(positions[source]);
                normals.push(normals[source]);
                uvs.push(uvs[source]);
                tangents.push(tangent);
                next.push(NONE);
            }
            *corner = vertex as u32;
        }
    }
    for vertex in 0..originals {
        if !taken[vertex] {
            tangents[vertex] = sound(Vec4::W, normals[vertex]);
        }
    }
}
