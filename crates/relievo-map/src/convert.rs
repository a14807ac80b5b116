//! Maps from other maps: normals from heights and back, occlusion, bent normals, curvature.
//!
//! Heights are in [0, 1]; `height_scale` is their full range as a fraction of one repeat along u.
//! Texels are taken as square.

mod curvature;
mod derivative;
mod integrate;
mod occlusion;
mod periodic;
mod slopes;
mod strips;

pub use curvature::curvature;
pub use derivative::{Border, DerivativeKernel};
pub use integrate::{HeightFromNormal, IntegrateOptions, normal_to_height};
pub use occlusion::{OcclusionOptions, ambient_occlusion, bent_normals};
pub use periodic::periodic;
pub use slopes::height_to_normal;
