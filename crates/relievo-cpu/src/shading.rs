//! The colour of a surface point: lights, material, reflection.

pub(crate) mod environment;
pub(crate) mod light;
pub(crate) mod material;
pub(crate) mod material_sample;
pub(crate) mod mean_normal;
pub(crate) mod reflection;
