//! Cone stepping: the cones of a height map, how they are built, and the march through them.

mod build;
mod cone_field;
mod cone_map;
mod cone_march;
mod cones;
mod limits;
mod slope;

pub use cone_field::ConeField;
pub use cone_map::ConeMap;
pub(crate) use cone_march::cone_crossing;
pub use cones::Cones;
