//! Meshes: triangle lists with tangents, the built-in shapes, and their triangles in scene space.

mod back;
mod build;
mod charts;
mod directions;
mod faces;
mod far_uvs;
mod in_scene_space;
mod indexed_mesh;
mod march_space;
mod moved_uvs;
mod number_key;
mod relief_depth;
mod shapes;
mod surface_mesh;
mod tangents;
mod tessellate;
mod vertex;

pub use charts::Chart;
pub(crate) use faces::{crease_normals, flat_normals, has_area};
pub use indexed_mesh::{Mesh, MeshError};
pub use march_space::MarchSpace;
pub use relief_depth::ReliefDepth;
pub use shapes::SHAPE_NAMES;
pub use surface_mesh::SurfaceMesh;
pub use vertex::{Face, Vertex};
