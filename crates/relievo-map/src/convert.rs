//! Maps out of other maps: normals from heights and back, occlusion, bent normals, curvature.
//!
//! Heights are in [0, 1]; how high that is says `height_scale`, the full range as a fraction of one repeat along u.
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
