//! Meshes whose texture coordinates a material moves, turns or mirrors.

use glam::{Mat2, Vec2};

use super::indexed_mesh::Mesh;
use super::tangents;
use crate::UvTransform;

impl Mesh {
    /// Returns the mesh with transformed texture coordinates, and tangents along the new ones; `None` where they are only
    /// scaled, by numbers above 0.
    pub(super) fn with_moved_uvs(&self, transform: &UvTransform) -> Option<Self> {
        if transform.offset == Vec2::ZERO && transform.keeps_directions() {
            return None;
        }
        let mut mesh = self.clone();
        let rotation = transform.rotation();
        if rotation.x_axis.y == 0.0 {
            // Axes that keep their lines: the tangents are the same, or point the other way.
            let [u, v] = (rotation.x_axis.x * transform.scale).signum().to_array();
            for tangent in &mut mesh.tangents {
                *tangent = (tangent.truncate() * u).extend(tangent.w * u * v);
            }
        } else {
            // Tangents depend on directions alone; without their lengths the numbers stay small.
            let scale = transform.scale / transform.scale.abs().max_element();
            tangents::generate(&mut mesh, rotation * Mat2::from_diagonal(scale));
        }
        for uv in &mut mesh.uvs {
            *uv = transform.apply(*uv);
        }
        Some(mesh)
    }
}
