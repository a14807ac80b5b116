use glam::{DVec3, Vec2, Vec3, Vec4};
use thiserror::Error;

use crate::tangents;

/// Triangles with everything a relief needs at each vertex.
///
/// All vertex lists have the same length; every index is below it; all numbers are finite.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Object units.
    pub positions: Vec<Vec3>,
    /// Unit length.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, origin at the picture's top left, v down. The base range is 0..1.
    pub uvs: Vec<Vec2>,
    /// MikkTSpace tangents: xyz along +u, unit length; w = ±1, bitangent (picture up) = w · (normal × tangent).
    pub tangents: Vec<Vec4>,
    /// Triangles, counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
}

/// Why a [`Mesh`] could not be made.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum MeshError {
    /// There is nothing to draw.
    #[error("the mesh has no triangles")]
    Empty,
    /// Two vertex lists differ in length.
    #[error("{positions} positions but {count} {list}: all vertex lists must have the same length")]
    Lengths {
        /// Number of positions.
        positions: usize,
        /// Name of the other list.
        list: &'static str,
        /// Its length.
        count: usize,
    },
    /// A triangle names a vertex that is not there.
    #[error("triangle {triangle} names vertex {index}, but there are {vertices}")]
    Index {
        /// Which triangle, from 0.
        triangle: usize,
        /// The vertex it names.
        index: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// A number is NaN, infinite or beyond [`Mesh::MAX_COORDINATE`].
    #[error("vertex {vertex}: a number of its {list} is not finite or above {max:e}", max = Mesh::MAX_COORDINATE)]
    Number {
        /// Which vertex, from 0.
        vertex: usize,
        /// Which of its properties.
        list: &'static str,
    },
    /// A normal or tangent is not of unit length, or a sign is not ±1 (see [`Mesh::validate`]).
    #[error("vertex {vertex}: its {list} is not of unit length, or its sign is not ±1")]
    Unit {
        /// Which vertex, from 0.
        vertex: usize,
        /// `normal` or `tangent`.
        list: &'static str,
    },
    /// Over [`Mesh::MAX_TRIANGLES`].
    #[error("{0} triangles: a mesh may have at most {max}", max = Mesh::MAX_TRIANGLES)]
    TooManyTriangles(usize),
}

impl Mesh {
    /// The most triangles a mesh may have.
    pub const MAX_TRIANGLES: usize = 50_000_000;
    /// The largest magnitude of a vertex number: squares and products of two stay finite in f32.
    pub const MAX_COORDINATE: f32 = 1e9;

    /// A mesh from complete vertex lists; for files that bring their own tangents.
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

    /// A mesh whose tangents are generated: MikkTSpace (Mikkelsen 2008, "Simulation of Wrinkled Surfaces Revisited"),
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
        tangents::generate(&mut mesh);
        Ok(mesh)
    }

    /// Checks everything this type promises, for meshes put together by hand.
    ///
    /// # Errors
    /// The first promise that does not hold.
    pub fn validate(&self) -> Result<(), MeshError> {
        self.check_shape()?;
        for (vertex, (normal, tangent)) in self.normals.iter().zip(&self.tangents).enumerate() {
            if (normal.length() - 1.0).abs() > 1e-3 {
                return Err(MeshError::Unit { vertex, list: "normal" });
            }
            if (tangent.truncate().length() - 1.0).abs() > 1e-3 || tangent.w.abs() != 1.0 {
                return Err(MeshError::Unit { vertex, list: "tangent" });
            }
        }
        Ok(())
    }

    fn check_shape(&self) -> Result<(), MeshError> {
        let vertices = self.positions.len();
        if self.triangles.is_empty() {
            return Err(MeshError::Empty);
        }
        if self.triangles.len() > Self::MAX_TRIANGLES {
            return Err(MeshError::TooManyTriangles(self.triangles.len()));
        }
        for (list, count) in
            [("normals", self.normals.len()), ("uvs", self.uvs.len()), ("tangents", self.tangents.len())]
        {
            if count != vertices {
                return Err(MeshError::Lengths { positions: vertices, list, count });
            }
        }
        for (triangle, corners) in self.triangles.iter().enumerate() {
            if let Some(&index) = corners.iter().find(|&&index| index as usize >= vertices) {
                return Err(MeshError::Index { triangle, index, vertices });
            }
        }
        check_numbers("position", &self.positions)?;
        check_numbers("normal", &self.normals)?;
        check_numbers("uv", &self.uvs)?;
        check_numbers("tangent", &self.tangents)
    }

    /// Normals to unit length; those without any from the triangles around the vertex, weighted by area.
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

fn check_numbers<const N: usize, T: Copy + Into<[f32; N]>>(list: &'static str, values: &[T]) -> Result<(), MeshError> {
    let sound = |x: f32| x.abs() <= Mesh::MAX_COORDINATE; // false for NaN
    match values.iter().position(|&v| !v.into().into_iter().all(sound)) {
        Some(vertex) => Err(MeshError::Number { vertex, list }),
        None => Ok(()),
    }
}

/// The triangle's normal times twice its area, in f64 so that small triangles keep theirs.
pub(crate) fn area_vector(positions: &[Vec3], [a, b, c]: [u32; 3]) -> DVec3 {
    let [a, b, c] = [a, b, c].map(|index| positions[index as usize].as_dvec3());
    (b - a).cross(c - a)
}
