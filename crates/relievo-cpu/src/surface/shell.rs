//! Rays through the shells of reliefs on curved meshes.

use glam::Vec3;
use relievo_march::{
    Footprint, ObjectField, ReliefMap, ShellHit, ShellOutcome, ShellRay, Sides, march_shell, march_shell_from_above,
    oracle_shell,
};

use super::first_surface::SurfacePoint;
use super::patch::Patch;
use super::view_ray::{MarchCost, ViewRay};
use crate::Precision;
use crate::geometry::{TriangleHit, World};

/// The fraction of the depth that is left at least where level of detail fades it: a shell has to have a depth.
const LEAST_FADE: f32 = 1e-3;

/// A triangle that a ray comes over below its surface, and the distance.
pub(super) type HiddenShell = (u32, f32);

impl World {
    /// Marches a view ray through the shell over a triangle, to the first point of the surface up to the distance `limit`. With
    /// `hidden`: a triangle that the ray comes over below the surface is put off.
    pub(super) fn shell_point(
        &self,
        triangle: u32,
        ray: &ViewRay<'_>,
        limit: f32,
        precision: Precision,
        (cost, hidden): (&mut MarchCost, Option<&mut Vec<HiddenShell>>),
    ) -> Option<SurfacePoint<'_>> {
        let (_, material) = self.instance_of(triangle);
        let (_, heights) = material.march()?;
        let (fade, footprint) =
            if material.relief.lod { self.detail(triangle, ray) } else { (1.0, Footprint::default()) };
        let faded;
        let prism = if fade < 1.0 {
            faded = self.prism(triangle).faded(fade);
            &faded
        } else {
            self.prism(triangle)
        };
        let shell_ray = ShellRay { origin: ray.origin.into(), direction: ray.direction.into() };
        let range = [ray.near, limit];
        let field = self.shell_field(triangle, heights, &footprint);
        let (hit, costs) = match (precision, hidden) {
            (Precision::Single, None) => march_shell(&field, prism, &shell_ray, range, Sides::Above),
            (Precision::Single, Some(hidden)) => {
                let (found, costs) = march_shell_from_above(&field, prism, &shell_ray, range);
                (put_off(found, triangle, hidden), costs)
            }
            (Precision::Oracle, _) => oracle_shell(&field, prism, &shell_ray, range, Sides::Above),
        };
        cost.fetches += costs.fetches;
        cost.iterations += costs.iterations;
        let hit = hit.filter(|hit| hit.t < limit)?;
        let position = ray.origin + ray.direction * hit.t;
        let footprint = if material.needs_footprint { self.detail(triangle, ray).1 } else { footprint };
        let patch = Patch::new(self, triangle, &TriangleHit { t: hit.t, weights: hit.weights });
        Some(SurfacePoint { patch, triangle, t: hit.t, position, record: hit.record, footprint, from_behind: false })
    }

    /// Returns true if a relief in shells hides a light from a point of the instance `receiver`, between two distances;
    /// `only`: the relief of one instance.
    pub(super) fn is_behind_shell(
        &self,
        origin: Vec3,
        direction: Vec3,
        range: [f32; 2],
        (receiver, only): (u32, Option<u32>),
    ) -> bool {
        let hides = |triangle: u32| {
            let caster = self.owner[triangle as usize];
            only.is_none_or(|only| caster == only)
                && self.casts_on(caster, receiver)
                && self.shell_hides(triangle, origin, direction, range)
        };
        self.shell_bvh.any(origin, direction, range[1], hides)
    }

    /// Returns true if the shell over a triangle hides what lies on a ray between two distances.
    pub(super) fn shell_hides(&self, triangle: u32, origin: Vec3, direction: Vec3, range: [f32; 2]) -> bool {
        let Some((_, heights)) = self.instance_of(triangle).1.march() else { return false };
        let field = self.shell_field(triangle, heights, &Footprint::default());
        let ray = ShellRay { origin: origin.into(), direction: direction.into() };
        march_shell(&field, self.prism(triangle), &ray, range, Sides::Both).0.is_some()
    }

    fn shell_field<'a>(&'a self, triangle: u32, heights: &'a ReliefMap, footprint: &Footprint) -> ObjectField<'a> {
        let (_, material) = self.instance_of(triangle);
        let lod = if material.relief.lod { footprint.march_lod(heights.size()) } else { 0.0 };
        material.field(heights, lod, self.range(triangle))
    }

    /// Returns the fraction of its depth that the relief keeps where the ray comes nearest to a triangle, and the pixel's
    /// footprint there.
    fn detail(&self, triangle: u32, ray: &ViewRay<'_>) -> (f32, Footprint) {
        let [a, b, c] = self.positions(triangle);
        let normal = (b - a).cross(c - a);
        let t = (a - ray.origin).dot(normal) / ray.direction.dot(normal);
        let point = ray.origin + ray.direction * t;
        let weight =
            |p: Vec3, q: Vec3| ((p - point).cross(q - point).dot(normal) / normal.length_squared()).clamp(0.0, 1.0);
        let weights = [weight(b, c), weight(c, a), weight(a, b)];
        let sum: f32 = weights.iter().sum();
        // Also where the ray runs along the triangle.
        let weights = if sum > 0.0 && sum.is_finite() { weights.map(|w| w / sum) } else { [1.0 / 3.0; 3] };
        let mut patch = Patch::new(self, triangle, &TriangleHit { t, weights });
        let footprint = patch.footprint(ray);
        let footprint = patch.fade(footprint);
        (patch.kept_depth().max(LEAST_FADE), footprint)
    }
}

fn put_off(found: ShellOutcome, triangle: u32, hidden: &mut Vec<HiddenShell>) -> Option<ShellHit> {
    match found {
        ShellOutcome::Hit(hit) => Some(hit),
        ShellOutcome::Hidden(t) => {
            hidden.push((triangle, t));
            None
        }
        ShellOutcome::Miss => None,
    }
}
