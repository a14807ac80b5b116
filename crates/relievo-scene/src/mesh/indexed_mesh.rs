use glam::{DVec3, Vec2, Vec3, Vec4};
use thiserror::Error;

/// An indexed triangle list with the vertex data that a relief needs.
///
/// All vertex lists have the same length; every index is below it; all numbers are finite.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertex positions, object units.
    pub positions: Vec<Vec3>,
    /// Vertex normals, unit length.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, origin at the picture's top left, v down. The base range is 0..1.
    pub uvs: Vec<Vec2>,
    /// MikkTSpace tangents: xyz along +u, unit length; w = ±1, bitangent (picture up) = w · (normal × tangent).
    pub tangents: Vec<Vec4>,
    /// Triangles, counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
}

/// Reason why a [`Mesh`] could not be made.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
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
        /// Index of the triangle.
        triangle: usize,
        /// Index of the vertex that it names.
        index: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// A number is NaN, infinite or beyond [`Mesh::MAX_COORDINATE`].
    #[error("vertex {vertex}: a number of its {list} is not finite or above {max:e}", max = Mesh::MAX_COORDINATE)]
    Number {
        /// Index of the vertex.
        vertex: usize,
        /// Property of the vertex.
        list: &'static str,
    },
    /// A normal or tangent is not of unit length, or a sign is not ±1 (see [`Mesh::validate`]).
    #[error("vertex {vertex}: its {list} is not of unit length, or its sign is not ±1")]
    Unit {
        /// Index of the vertex.
        vertex: usize,
        /// `normal` or `tangent`.
        list: &'static str,
    },
    /// There are more triangles than [`Mesh::MAX_TRIANGLES`].
    #[error("{0} triangles: a mesh may have at most {max}", max = Mesh::MAX_TRIANGLES)]
    TooManyTriangles(usize),
}

impl Mesh {
    /// Most triangles of a mesh.
    pub const MAX_TRIANGLES: usize = 50_000_000;
    /// Largest magnitude of a vertex number: squares and products of two stay finite in f32.
    pub const MAX_COORDINATE: f32 = 1e9;

    /// Checks everything that this type promises, for meshes put together in code.
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

    pub(super) fn check_shape(&self) -> Result<(), MeshError> {
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
}

fn check_numbers<const N: usize, T: Copy + Into<[f32; N]>>(list: &'static str, values: &[T]) -> Result<(), MeshError> {
    let sound = |x: f32| x.abs() <= Mesh::MAX_COORDINATE; // false for NaN
    match values.iter().position(|&v| !v.into().into_iter().all(sound)) {
        Some(vertex) => Err(MeshError::Number { vertex, list }),
        None => Ok(()),
    }
}

/// Returns the triangle's normal times twice its area, in f64 so that small triangles keep theirs.
pub(super) fn area_vector(positions: &[Vec3], [a, b, c]: [u32; 3]) -> DVec3 {
    let [a, b, c] = [a, b, c].map(|index| positions[index as usize].as_dvec3());
    (b - a).cross(c - a)
}
