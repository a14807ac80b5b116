use super::surface_mesh::SurfaceMesh;
use super::vertex::Vertex;

impl SurfaceMesh {
    /// Returns the same polygons seen from behind: fronts and normals turned round, uvs and their axes as they are.
    #[must_use]
    pub fn back(&self) -> Self {
        let turned = |vertex: &Vertex| {
            // With the normal the bitangent would turn too.
            let tangent = vertex.tangent.truncate().extend(-vertex.tangent.w);
            Vertex { normal: -vertex.normal, direction: -vertex.direction, tangent, ..*vertex }
        };
        Self {
            vertices: self.vertices.iter().map(turned).collect(),
            triangles: self.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect(),
            face_of: self.face_of.clone(),
            faces: self.faces.clone(),
            charts: self.charts.clone(),
        }
    }
}
