use glam::{Vec2, Vec3, Vec4};
use relievo_march::Corner;

/// A corner of a triangle in scene space, with the data that a relief needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Position, scene units.
    pub position: Vec3,
    /// Normal: unit length on meshes; between their vertices as interpolated.
    pub normal: Vec3,
    /// Direction along which the relief rises: the normal, or one that all vertices at a position share (see
    /// [`crate::Offset`]).
    pub direction: Vec3,
    /// Tangent: xyz along +u, w the handedness: bitangent (picture up) = w · (normal × tangent).
    pub tangent: Vec4,
    /// Texture coordinates, in texture repeats. Whole repeats may have been taken off, the same for a whole triangle.
    pub uv: Vec2,
    /// Length of one texture repeat along u on this vertex's chart, scene units: see [`crate::Chart::repeat_length`].
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
    /// Index of the face's chart in [`crate::SurfaceMesh::charts`].
    pub chart: u32,
}

impl Face {
    /// Returns true if the triangle's texture coordinates span an area, so that its axes are the texture's.
    pub(super) fn has_texture(uvs: [Vec2; 3]) -> bool {
        let area = (uvs[1] - uvs[0]).perp_dot(uvs[2] - uvs[0]);
        area != 0.0 && area.is_finite()
    }
}
