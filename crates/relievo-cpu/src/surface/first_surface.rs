//! The first surface along a view ray.

use glam::Vec3;
use relievo_march::{Footprint, Record};

use super::patch::Patch;
use super::view_ray::{MarchCost, ViewRay};
use crate::Precision;
use crate::geometry::{MicroRay, ShearedRay, Sides, TriangleHit, World};

/// The point where a ray meets a surface.
pub(crate) struct SurfacePoint<'a> {
    pub(crate) patch: Patch<'a>,
    pub(crate) triangle: u32,
    /// Distance along the ray.
    pub(crate) t: f32,
    /// The point that lights are seen from, scene space.
    pub(crate) position: Vec3,
    /// True if the polygon is seen from behind.
    pub(crate) from_behind: bool,
    pub(crate) record: Record,
    pub(crate) footprint: Footprint,
}

impl World {
    /// Returns the first surface along a ray, and the cost of the marches on the way.
    pub(crate) fn first_surface(
        &self,
        ray: &ViewRay<'_>,
        precision: Precision,
    ) -> (Option<SurfacePoint<'_>>, MarchCost) {
        let sheared = ShearedRay::new(ray.origin, ray.direction);
        let mut cost = MarchCost::default();
        let mut best: Option<SurfacePoint<'_>> = None;
        self.bvh.nearest(ray.origin, ray.direction, f32::INFINITY, |triangle, nearest| {
            let hit = sheared.hit(self.positions(triangle)).filter(|hit| hit.t < nearest);
            let point = hit.and_then(|hit| self.surface_at(triangle, &hit, ray, precision, &mut cost));
            match point.filter(|point| point.t < nearest && point.t >= ray.near) {
                Some(point) => best.insert(point).t,
                None => f32::INFINITY,
            }
        });
        // A relief that rises towards the eye may be nearer than what lies before its polygon.
        self.raised_bvh.nearest(ray.origin, ray.direction, f32::INFINITY, |triangle, _| {
            let hit = sheared.hit(self.positions(triangle));
            let point = hit.and_then(|hit| self.surface_at(triangle, &hit, ray, precision, &mut cost));
            let nearest = best.as_ref().map_or(f32::INFINITY, |best| best.t);
            if let Some(point) = point.filter(|point| point.t < nearest && point.t >= ray.near) {
                best = Some(point);
            }
            f32::INFINITY
        });
        // Shells hold all of their relief: what lies behind the best so far is not looked at.
        let limit = best.as_ref().map_or(f32::INFINITY, |best| best.t);
        let mut hidden = Vec::new();
        self.shell_bvh.nearest(ray.origin, ray.direction, limit, |triangle, nearest| {
            match self.shell_point(triangle, ray, nearest.min(limit), precision, (&mut cost, Some(&mut hidden))) {
                Some(point) => best.insert(point).t,
                None => f32::INFINITY,
            }
        });
        // What a ray meets after it has come out of a relief; mostly something before it has been found.
        for (triangle, t) in hidden {
            let limit = best.as_ref().map_or(f32::INFINITY, |best| best.t);
            if t < limit
                && let Some(point) = self.shell_point(triangle, ray, limit, precision, (&mut cost, None))
            {
                best = Some(point);
            }
        }
        if !self.micro_bvh.is_empty() {
            self.first_micro_surface(ray, &mut best);
        }
        (best, cost)
    }

    /// Replaces `best` by the first point of a displaced surface that is traced without being kept, if that is nearer.
    fn first_micro_surface<'a>(&'a self, ray: &ViewRay<'_>, best: &mut Option<SurfacePoint<'a>>) {
        let micro_ray = MicroRay::new(ray.origin, ray.direction, ray.near);
        let limit = best.as_ref().map_or(f32::INFINITY, |best| best.t);
        self.micro_bvh.nearest(ray.origin, ray.direction, limit, |triangle, nearest| {
            let hit = self.micro_hit(triangle, &micro_ray, ray.raise, nearest, Sides::Front);
            let Some(hit) = hit.filter(|hit| (hit.t as f32) < nearest) else {
                return f32::INFINITY;
            };
            let on_polygon = TriangleHit { t: hit.t as f32, weights: hit.weights.map(|w| w as f32) };
            let mut patch = Patch::new(self, triangle, &on_polygon);
            let on_base = patch.point;
            (patch.point, patch.geometric_normal) = (hit.point.as_vec3(), hit.normal.as_vec3());
            let footprint = if patch.material.needs_footprint { patch.footprint(ray) } else { Footprint::default() };
            let footprint = patch.fade(footprint);
            let record = Record { depth: patch.depth_at(hit.point.as_vec3(), on_base), ..patch.on_polygon() };
            let (t, position) = (on_polygon.t, patch.point);
            best.insert(SurfacePoint { patch, triangle, t, position, from_behind: false, record, footprint }).t
        });
    }

    fn surface_at(
        &self,
        triangle: u32,
        hit: &TriangleHit,
        ray: &ViewRay<'_>,
        precision: Precision,
        cost: &mut MarchCost,
    ) -> Option<SurfacePoint<'_>> {
        let mut patch = Patch::new(self, triangle, hit);
        let to_eye = -ray.direction;
        let from_behind = patch.geometric_normal.dot(ray.direction) > 0.0;
        if patch.is_displaced() && !patch.material.two_sided && patch.geometric_normal.dot(to_eye) <= 0.0 {
            return None;
        }
        if patch.is_cut_off() {
            return None;
        }
        let footprint = if patch.material.needs_footprint { patch.footprint(ray) } else { Footprint::default() };
        let footprint = patch.fade(footprint);
        let (record, cos) = patch.march(to_eye, hit.t - ray.near, &footprint, precision, cost)?;
        let mut t = hit.t;
        let mut position = patch.point;
        if patch.material.march().is_some() && patch.material.relief.writes_depth() && cos > 0.0 {
            t += patch.beyond_polygon(record.depth, cos);
            position = ray.origin + ray.direction * t;
        }
        Some(SurfacePoint { patch, triangle, t, position, from_behind, record, footprint })
    }
}
