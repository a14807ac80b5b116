//! Meshes: triangle lists with tangents, the built-in shapes, and their triangles in scene space.

mod back;
mod build;
mod charts;
mod directions;
mod faces;
mod far_uvs;
mod indexed_mesh;
mod moved_uvs;
mod shapes;
mod surface_mesh;
mod tangents;
mod tessellate;

pub(crate) use faces::{crease_normals, flat_normals, has_area};
pub use indexed_mesh::{Mesh, MeshError};
pub use shapes::SHAPE_NAMES;
pub use charts::Chart;
pub use surface_mesh::{Face, ReliefDepth, SurfaceMesh, Vertex};
