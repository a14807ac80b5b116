//! Surface points: the polygon that a ray meets, its relief, and what hides the lights.

mod first_surface;
mod mist;
mod occlusion;
mod patch;
mod shell;
mod view_ray;

pub(crate) use first_surface::SurfacePoint;
pub(crate) use mist::MistPart;
pub(crate) use occlusion::OccluderSet;
pub(crate) use view_ray::{MarchCost, ViewRay};
