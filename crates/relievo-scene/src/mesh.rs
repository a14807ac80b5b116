use glam::{Vec2, Vec3, Vec4};

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
