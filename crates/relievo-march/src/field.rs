//! Height fields: the trait that marches sample, and the fields of this crate.

mod altered;
mod clipped_field;
mod column_wall;
mod height_field;
mod object_field;
mod relief_map;

pub(crate) use altered::Negated;
pub use altered::{Raised, WithoutPyramid};
pub(crate) use clipped_field::ClippedField;
pub use column_wall::ColumnWall;
pub use height_field::HeightField;
pub use object_field::{ObjectField, inset};
pub use relief_map::{HeightFieldView, ReliefMap};
