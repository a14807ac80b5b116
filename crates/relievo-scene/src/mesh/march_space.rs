use relievo_march::Technique;

use super::surface_mesh::SurfaceMesh;
use crate::{Edge, HeightRange, Material, SurfaceTechnique};

/// The spaces in which a relief can be marched.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MarchSpace {
    /// The plane of each polygon, with its normal at the point where the ray meets it: exact on flat meshes.
    Plane,
    /// The shell between the lowest and the highest height over each triangle, along the interpolated normals: exact on any
    /// mesh, with its silhouette.
    Shell,
}

impl SurfaceMesh {
    /// Returns the space in which a material's relief is marched on this mesh.
    #[must_use]
    pub fn march_space(&self, material: &Material) -> MarchSpace {
        let (HeightRange::Scale(depth) | HeightRange::Depth(depth)) = material.height;
        let relief = &material.relief;
        let marched = material.maps.height.is_some() && depth > 0.0;
        let exact = relief.technique == SurfaceTechnique::Marched(Technique::Exact);
        let shell = match relief.edge {
            Edge::Silhouette => true,
            // Only there the chart's range is where it ends.
            Edge::Clip => !self.charts.iter().all(|chart| chart.is_flat && chart.is_rectangle),
            Edge::Wrap | Edge::Clamp => false,
        };
        if marched && exact && shell { MarchSpace::Shell } else { MarchSpace::Plane }
    }
}
