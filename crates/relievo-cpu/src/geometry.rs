//! The triangles of a scene, and what a ray meets of them.

mod bvh;
mod displaced;
mod triangle;
mod world;

pub(crate) use displaced::{MAX_RAISE, MicroRay, Sides};
pub(crate) use triangle::{ShearedRay, TriangleHit};
pub(crate) use world::World;
