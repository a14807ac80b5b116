//! Making a mesh from vertex lists, with sound normals and tangents.

use glam::{DVec3, Mat2, Vec2, Vec3, Vec4};

use super::indexed_mesh::{Mesh, MeshError, area_vector};
use super::tangents;

impl Mesh {
    /// Makes a mesh from complete vertex lists; for files that bring their own tangents.
    ///
    /// Normals and tangents are normalised; where they have no length they are made from the triangles. The tangents'
    /// w becomes ±1.
    ///
    /// # Errors
    /// If lists differ in length, an index is too large, a number is not finite or there are no or too many triangles.
    pub fn from_parts(
        positions: Vec<Vec3>,
        normals: Vec<Vec3>,
        uvs: Vec<Vec2>,
        tangents: Vec<Vec4>,
        triangles: Vec<[u32; 3]>,
    ) -> Result<Self, MeshError> {
        let mut mesh = Self { positions, normals, uvs, tangents, triangles };
        mesh.check_shape()?;
        mesh.repair_normals();
        for (tangent, &normal) in mesh.tangents.iter_mut().zip(&mesh.normals) {
            *tangent = tangents::sound(*tangent, normal);
        }
        Ok(mesh)
    }

    /// Makes a mesh whose tangents are generated: MikkTSpace (Mikkelsen 2008, "Simulation of Wrinkled Surfaces Revisited"),
    /// the bitangent pointing *up* in the picture as in glTF.
    ///
    /// Vertices are split where tangents differ (mirrored texture coordinates, for instance), so that the mesh may have
    /// more vertices than were given. Normals are treated as in [`Mesh::from_parts`].
    ///
    /// # Errors
    /// As [`Mesh::from_parts`].
    pub fn with_tangents(
        positions: Vec<Vec3>,
        normals: Vec<Vec3>,
        uvs: Vec<Vec2>,
        triangles: Vec<[u32; 3]>,
    ) -> Result<Self, MeshError> {
        let tangents = vec![Vec4::ZERO; positions.len()];
        let mut mesh = Self { positions, normals, uvs, tangents, triangles };
        mesh.check_shape()?;
        mesh.repair_normals();
        tangents::generate(&mut mesh, Mat2::IDENTITY);
        Ok(mesh)
    }

    /// Normalises normals; those of length 0 are made from the triangles around the vertex, weighted by area.
    fn repair_normals(&mut self) {
        let mut missing = false;
        for normal in &mut self.normals {
            match normal.as_dvec3().try_normalize() {
                Some(unit) => *normal = unit.as_vec3(),
                None => {
                    *normal = Vec3::ZERO;
                    missing = true;
                }
            }
        }
        if !missing {
            return;
        }
        let mut sums = vec![DVec3::ZERO; self.positions.len()];
        for &triangle in &self.triangles {
            let area = area_vector(&self.positions, triangle);
            for corner in triangle {
                sums[corner as usize] += area;
            }
        }
        for (normal, sum) in self.normals.iter_mut().zip(sums) {
            if *normal == Vec3::ZERO {
                *normal = sum.try_normalize().unwrap_or(DVec3::Z).as_vec3();
            }
        }
    }
}
