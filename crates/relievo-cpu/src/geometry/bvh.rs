use glam::{Vec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::ray::{Ray, RayHit};
use obvhs::{Boundable, BvhBuildParams};

/// The box around a triangle, for building the hierarchy.
pub(crate) struct Bounds {
    aabb: Aabb,
}

impl Bounds {
    /// Returns the box of some corners.
    pub(crate) fn around(corners: &[Vec3]) -> Self {
        let min = corners.iter().fold(Vec3::INFINITY, |min, &corner| min.min(corner));
        let max = corners.iter().fold(Vec3::NEG_INFINITY, |max, &corner| max.max(corner));
        Self::between(min, max)
    }

    /// Returns the box with these corners.
    pub(crate) fn between(min: Vec3, max: Vec3) -> Self {
        // The tree's box test rounds: a flat box must not be missed for that.
        let margin = min.abs().max(max.abs()) * 4e-6;
        Self { aabb: Aabb::new(Vec3A::from(min - margin), Vec3A::from(max + margin)) }
    }
}

impl Boundable for Bounds {
    fn aabb(&self) -> Aabb {
        self.aabb
    }
}

/// A bounding volume hierarchy over triangles of the world.
#[derive(Default)]
pub(crate) struct TriangleBvh {
    bvh: Bvh2,
}

impl TriangleBvh {
    /// Builds a hierarchy over triangles with these boxes and these numbers.
    pub(crate) fn build(bounds: &[Bounds], triangles: &[u32]) -> Self {
        if bounds.is_empty() {
            return Self { bvh: Bvh2::default() };
        }
        // Building costs more than tracing here: pictures are small, displaced grids have millions of triangles.
        let params = BvhBuildParams::very_fast_build();
        let mut bvh = build_bvh2(bounds, params, &mut std::time::Duration::default());
        for index in &mut bvh.primitive_indices {
            *index = triangles[*index as usize];
        }
        Self { bvh }
    }

    /// True if there are no triangles.
    pub(crate) fn is_empty(&self) -> bool {
        self.bvh.nodes.is_empty()
    }

    /// Calls `test(triangle, nearest so far)` for every triangle whose box the ray passes nearer than the nearest hit so
    /// far. `test` returns the distance of its hit, or infinity.
    pub(crate) fn nearest(&self, origin: Vec3, direction: Vec3, limit: f32, mut test: impl FnMut(u32, f32) -> f32) {
        if self.bvh.nodes.is_empty() {
            return;
        }
        let ray = Ray::new(origin.into(), direction.into(), 0.0, limit);
        self.bvh.ray_traverse(ray, &mut RayHit::none(), |ray, slot| test(self.bvh.primitive_indices[slot], ray.tmax));
    }

    /// Returns true if `test(triangle)` holds for any triangle whose box the ray passes nearer than `limit`.
    pub(crate) fn any(&self, origin: Vec3, direction: Vec3, limit: f32, mut test: impl FnMut(u32) -> bool) -> bool {
        if self.bvh.nodes.is_empty() {
            return false;
        }
        let ray = Ray::new(origin.into(), direction.into(), 0.0, limit);
        !self.bvh.ray_traverse_miss(
            ray,
            |_, slot| {
                if test(self.bvh.primitive_indices[slot]) { 0.0 } else { f32::INFINITY }
            },
        )
    }
}
