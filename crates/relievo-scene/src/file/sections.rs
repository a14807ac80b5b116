//! The tables of a scene file, checked and turned into parts of a scene.

pub(super) mod animate;
pub(super) mod camera;
pub(super) mod clock;
pub(super) mod image;
pub(super) mod layer;
pub(super) mod light;
pub(super) mod material;
mod mist;
pub(super) mod object;
mod relief;
pub(super) mod shading;
mod uv;
