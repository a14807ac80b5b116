use glam::Mat3;

use super::vertex::Vertex;
use crate::{HeightRange, Object};

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
