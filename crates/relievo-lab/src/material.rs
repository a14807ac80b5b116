//! Materials under test: the lab's own height maps, generated and loaded materials, and the scene that shows one.

mod corpus;
mod test_material;
mod view;

pub use corpus::{corpus, corpus_description, corpus_names};
pub use test_material::{TestMaterial, TestMaterialError};
pub(crate) use view::MaterialView;
