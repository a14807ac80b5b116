//! The triangles of a scene, and what a ray meets of them.

mod bvh;
mod displaced;
mod instance;
mod triangle;
mod world;
mod world_builder;
mod world_key;

pub(crate) use displaced::{MAX_RAISE, MicroRay, Sides};
pub(crate) use triangle::{ShearedRay, TriangleHit};
pub(crate) use world::World;
pub(crate) use world_key::WorldKey;
