//! Shadow rays: what hides a light from a surface point.

use glam::Vec3;
use relievo_march::Footprint;

use super::first_surface::SurfacePoint;
use super::patch::Patch;
use super::view_ray::MarchCost;
use crate::Precision;
use crate::geometry::{MicroRay, ShearedRay, Sides, TriangleHit, World};

/// The objects that may hide a light.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum OccluderSet {
    /// Anything in the scene.
    Everything,
    /// Only the object itself.
    Itself,
}

impl World {
    /// Returns true if anything but the relief of `from` itself hides a light in `direction` at `distance`.
    pub(crate) fn is_hidden(
        &self,
        from: &SurfacePoint<'_>,
        occluders: OccluderSet,
        direction: Vec3,
        distance: f32,
    ) -> bool {
        let own = self.owner[from.triangle as usize];
        let own_is_marched = from.patch.material.march().is_some();
        let side = from.patch.geometric_normal.dot(direction).signum();
        let seen_side = if from.from_behind { -1.0 } else { 1.0 };
        let lift = from.patch.shadow_lift() * seen_side;
        if from.patch.is_displaced() && side * seen_side < 0.0 && lift == 0.0 {
            // A facet that faces away from the light is its own shadow, as it is where the relief is marched.
            return true;
        }
        // Clear of the surface it starts on, in proportion to where f32 stops telling points apart.
        let extent = |point: Vec3| point.abs().max_element();
        let own_extent = if from.patch.is_micro() {
            // Its triangle may be as large as the object; the facet is not.
            extent(from.position)
        } else {
            self.positions(from.triangle).map(extent).into_iter().fold(extent(from.position), f32::max)
        };
        let clearance = 1e-5 * own_extent;
        let origin = if self.is_shell(from.triangle) {
            from.position + from.patch.shell_clearance(&from.record)
        } else if own_is_marched {
            from.position
        } else {
            from.position + from.patch.geometric_normal * (side * clearance) + from.patch.frame.z_axis * lift
        };
        let blocks = |triangle: u32, hit: &TriangleHit| {
            let caster = self.owner[triangle as usize];
            let is_own = caster == own;
            if !self.casts_on(caster, own) || (occluders == OccluderSet::Itself && !is_own) {
                return false;
            }
            let (_, material) = self.instance_of(triangle);
            if material.march().is_none() {
                return hit.t < distance && !Patch::new(self, triangle, hit).is_cut_off();
            }
            let [a, b, c] = self.positions(triangle);
            let entering = (b - a).cross(c - a).dot(direction) < 0.0;
            // A point under its own lid leaves through it; the march towards the light has dealt with that.
            if is_own && own_is_marched && (!entering || hit.t < clearance) {
                return false;
            }
            self.relief_distance(triangle, hit, direction, entering, clearance)
                .is_some_and(|t| t > clearance && t < distance)
        };
        let forward = ShearedRay::new(origin, direction);
        let meets = |triangle: u32| forward.hit(self.positions(triangle)).is_some_and(|hit| blocks(triangle, &hit));
        if self.bvh.any(origin, direction, distance, meets)
            || self.raised_bvh.any(origin, direction, f32::INFINITY, meets)
        {
            return true;
        }
        // Lifted off its own relief, a shell's point is clear of it.
        let near = if self.is_shell(from.triangle) { 0.0 } else { clearance };
        let only = (occluders == OccluderSet::Itself).then_some(own);
        if self.is_behind_shell(origin, direction, [near, distance], (own, only))
            || self.is_behind_micro_surface(origin, direction, distance, only)
        {
            return true;
        }
        // Above the polygon of a raised relief, still among its bumps.
        let backward = ShearedRay::new(origin, -direction);
        self.raised_bvh.any(origin, -direction, f32::INFINITY, |triangle| {
            let hit = backward.hit(self.positions(triangle)).map(|hit| TriangleHit { t: -hit.t, ..hit });
            hit.is_some_and(|hit| blocks(triangle, &hit))
        })
    }

    /// Returns true if any surface hides a light in `direction` at `distance` from a point that lies on none.
    pub(crate) fn is_hidden_from_space(&self, origin: Vec3, direction: Vec3, distance: f32) -> bool {
        let clearance = 1e-5 * origin.abs().max_element();
        let casts = |triangle: u32| self.instances[self.owner[triangle as usize] as usize].front.is_none();
        let blocks = |triangle: u32, hit: &TriangleHit| {
            if !casts(triangle) {
                return false;
            }
            if self.instance_of(triangle).1.march().is_none() {
                return hit.t < distance;
            }
            let [a, b, c] = self.positions(triangle);
            let entering = (b - a).cross(c - a).dot(direction) < 0.0;
            self.relief_distance(triangle, hit, direction, entering, clearance)
                .is_some_and(|t| t > clearance && t < distance)
        };
        let forward = ShearedRay::new(origin, direction);
        let meets = |triangle: u32| forward.hit(self.positions(triangle)).is_some_and(|hit| blocks(triangle, &hit));
        if self.bvh.any(origin, direction, distance, meets)
            || self.raised_bvh.any(origin, direction, f32::INFINITY, meets)
            || self.shell_bvh.any(origin, direction, distance, |triangle| {
                casts(triangle) && self.shell_hides(triangle, origin, direction, [clearance, distance])
            })
            || self.is_behind_micro_surface(origin, direction, distance, None)
        {
            return true;
        }
        let backward = ShearedRay::new(origin, -direction);
        self.raised_bvh.any(origin, -direction, f32::INFINITY, |triangle| {
            let hit = backward.hit(self.positions(triangle)).map(|hit| TriangleHit { t: -hit.t, ..hit });
            hit.is_some_and(|hit| blocks(triangle, &hit))
        })
    }

    /// Returns the distance at which a ray towards a light meets the relief on a polygon, which it crosses inwards or outwards.
    fn relief_distance(
        &self,
        triangle: u32,
        hit: &TriangleHit,
        direction: Vec3,
        entering: bool,
        clearance: f32,
    ) -> Option<f32> {
        let patch = Patch::new(self, triangle, hit);
        // The relief is always marched from its front, whichever way the light goes.
        let outward = if entering { -direction } else { direction };
        let before = if entering { hit.t } else { f32::INFINITY };
        let (record, cos) =
            patch.march(outward, before, &Footprint::default(), Precision::Single, &mut MarchCost::default())?;
        let writes_depth = patch.material.relief.writes_depth();
        let beyond = if writes_depth && cos > 0.0 { patch.beyond_polygon(record.depth, cos) } else { 0.0 };
        let t = if entering { hit.t + beyond } else { hit.t - beyond };
        // On its way in, above a polygon whose relief rises, it has passed bumps behind it and has another one ahead.
        Some(if entering && t <= clearance { hit.t } else { t })
    }

    /// Returns true if a displaced surface that is traced without being kept hides a light; `only` that of one object.
    fn is_behind_micro_surface(&self, origin: Vec3, direction: Vec3, distance: f32, only: Option<u32>) -> bool {
        if self.micro_bvh.is_empty() {
            return false;
        }
        let ray = MicroRay::new(origin, direction, 0.0);
        self.micro_bvh.any(origin, direction, distance, |triangle| {
            only.is_none_or(|object| self.owner[triangle as usize] == object)
                && self.micro_hit(triangle, &ray, 0.0, distance, Sides::Any).is_some()
        })
    }
}
