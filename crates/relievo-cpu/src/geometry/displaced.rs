//! Displaced geometry that is traced without being kept: the triangles of a mesh cut into micro-triangles, of which a ray
//! makes those that it comes near.
//!
//! ```text
//!  triangle of the mesh ──4──▶ ──4──▶ … ──▶ micro-triangle: three points of the surface, met exactly
//!           │ box: its points + [lowest, highest offset] · its normals
//! ```
//!
//! The surface is S(a, b) = P(a, b) + (h(u, v) − midlevel) · depth · N(a, b)/|N(a, b)|: the triangle's points, its interpolated
//! normal, heights filtered in its own uv (the walls of nearest ones are a micro-triangle wide). All is in f64. Every corner of a micro-triangle is a function of its place in the
//! triangle alone, and on an edge of that edge alone, so that neighbours share their corners to the last bit.

mod axis;
mod base_triangle;
mod filtered_map;
mod local_box;
mod micro_ray;
mod search;
mod surface;

pub(crate) use filtered_map::HeightRanges;
pub(crate) use micro_ray::MicroRay;
pub(crate) use search::{MicroHit, Sides};
pub(crate) use surface::{MAX_RAISE, MicroSurface, RangedMap, TracedRelief};
