use glam::{Mat2, Mat3, Vec2, Vec3};
use relievo_march::{
    Footprint, HeightField, MarchOptions, ObjectField, OracleRay, Ray, Record, ReliefMap, march, oracle, shadow,
};
use relievo_scene::{ShadingModel, Vertex};

use crate::Precision;
use crate::material::{MaterialSample, MaterialShading};
use crate::mean_normal::MeanNormal;
use crate::triangle::{ShearedRay, TriangleHit};
use crate::world::World;

/// A ray through a pixel.
pub(crate) struct ViewRay<'a> {
    pub(crate) origin: Vec3,
    /// Unit length.
    pub(crate) direction: Vec3,
    /// The directions through the next pixels to the right and below: asked for only where maps have levels.
    pub(crate) neighbours: &'a dyn Fn() -> [Vec3; 2],
    /// Nearest distance that counts.
    pub(crate) near: f32,
}

/// A polygon where a ray crosses it, with the frame in which its relief is marched.
pub(crate) struct Patch<'a> {
    pub(crate) look: &'a MaterialShading,
    pub(crate) repeat: Vec2,
    /// In texture repeats.
    pub(crate) uv: Vec2,
    pub(crate) point: Vec3,
    /// Of the flat triangle, towards its front; unit length.
    pub(crate) geometric_normal: Vec3,
    /// Tangent, bitangent and normal as interpolated, not normalised: the inverse of how normal maps are baked (MikkTSpace).
    decode: Mat3,
    /// The same, orthonormal.
    frame: Mat3,
    /// (dP/du, dP/dv)⁻¹ in the frame: what one scene unit is in texture repeats.
    to_uv: Mat2,
    /// The distance between height 0 and 1, scene units, as it is marched: less than the full one where level of detail
    /// fades the relief to its polygon.
    depth: f32,
    full_depth: f32,
}

/// Where a ray meets a surface.
pub(crate) struct SurfacePoint<'a> {
    pub(crate) patch: Patch<'a>,
    pub(crate) triangle: u32,
    /// Distance along the ray.
    pub(crate) t: f32,
    /// Where lights are seen from.
    pub(crate) position: Vec3,
    pub(crate) record: Record,
    pub(crate) footprint: Footprint,
}

/// What the marches of one ray cost.
#[derive(Clone, Copy, Default)]
pub(crate) struct Cost {
    pub(crate) fetches: u32,
    pub(crate) iterations: u32,
}

impl<'a> Patch<'a> {
    fn new(world: &'a World, triangle: u32, hit: &TriangleHit) -> Self {
        let (thing, look) = world.thing_of(triangle);
        let corners = world.corners(triangle);
        let [a, b, c] = corners.map(|corner| corner.position);
        let vertex = Vertex::interpolate(corners, hit.weights);
        let tangent = vertex.tangent.truncate();
        let bitangent = vertex.normal.cross(tangent) * vertex.tangent.w;
        let normal = vertex.normal.normalize_or_zero();
        let along_u = (tangent - normal * normal.dot(tangent)).try_normalize();
        let along_u = along_u.unwrap_or_else(|| normal.any_orthonormal_vector());
        let to_uv = vertex.jacobian.inverse();
        Self {
            look,
            repeat: thing.repeat,
            uv: vertex.uv,
            point: vertex.position,
            geometric_normal: (b - a).cross(c - a).normalize_or_zero(),
            decode: Mat3::from_cols(tangent, bitangent, vertex.normal),
            frame: Mat3::from_cols(along_u, normal.cross(along_u) * vertex.tangent.w, normal),
            to_uv: if to_uv.is_finite() { to_uv } else { Mat2::ZERO },
            depth: thing.depth.at(&vertex),
            full_depth: thing.depth.at(&vertex),
        }
    }

    /// Takes away what of the depth cannot be seen by a pixel of this footprint; gives the footprint on what
    /// is left of the relief.
    fn fade(&mut self, footprint: Footprint) -> Footprint {
        let Some((_, heights)) = self.look.march().filter(|_| self.look.relief.lod) else {
            return footprint;
        };
        let fade = footprint.fade(heights.size(), (self.to_uv.x_axis * self.full_depth).into());
        self.depth = self.full_depth * fade;
        footprint.on_relief(heights.size(), fade)
    }

    /// Whether nothing is left of the relief's depth.
    fn is_faded(&self) -> bool {
        self.depth < self.full_depth && self.depth == 0.0
    }

    /// A ray along `toward` (unit length, scene space, away from the surface) in texture space, through `uv`.
    pub(crate) fn ray(&self, uv: [f32; 2], toward: Vec3) -> Ray {
        self.ray_through(self.depth, uv, toward)
    }

    fn ray_through(&self, depth: f32, uv: [f32; 2], toward: Vec3) -> Ray {
        let local = self.frame.transpose() * toward;
        let uv_delta = self.to_uv * local.truncate() * -depth;
        Ray { uv, uv_delta: uv_delta.into(), cos: local.z }
    }

    /// Whether the relief is real geometry here.
    fn is_displaced(&self) -> bool {
        self.look.is_displaced()
    }

    /// How far above displaced geometry shadow rays start: over the terraces of an 8-bit map, as where it is marched.
    fn shadow_lift(&self) -> f32 {
        match &self.look.heights {
            Some(heights) if self.is_displaced() => self.depth * heights.quantization_step(),
            _ => 0.0,
        }
    }

    /// How the relief of this patch is marched.
    pub(crate) fn options(&self) -> MarchOptions {
        self.look.relief.march(self.look.midlevel, self.repeat)
    }

    /// All maps but the normal at a displaced uv.
    pub(crate) fn texels(&self, uv: [f32; 2], footprint: &Footprint, model: ShadingModel) -> MaterialSample {
        self.look.texels(uv, footprint, self.repeat, model)
    }

    /// The height map at the level of detail that suits the footprint.
    pub(crate) fn field(&self, heights: &'a ReliefMap, footprint: &Footprint) -> ObjectField<'a> {
        let lod = if self.look.relief.lod { footprint.march_lod(heights.size()) } else { 0.0 };
        self.look.field(heights, lod, self.repeat)
    }

    /// The distance along a ray with this cosine between the polygon and a march's `depth`.
    fn beyond_polygon(&self, depth: f32, cos: f32) -> f32 {
        (depth - (1.0 - self.look.midlevel)) * self.depth / cos
    }

    /// Marches along `toward` (away from the surface). `None` where the relief was missed, or is seen from behind.
    fn march(&self, toward: Vec3, footprint: &Footprint, precision: Precision, cost: &mut Cost) -> Option<Record> {
        let on_polygon = Record { uv: self.uv.into(), depth: 1.0 - self.look.midlevel, hit: true, ..Record::default() };
        let options = self.options();
        let Some((_, heights)) = self.look.march() else {
            return Some(on_polygon);
        };
        if self.geometric_normal.dot(toward) <= 0.0 {
            return None;
        }
        let ray = self.ray(self.uv.into(), toward);
        if ray.cos <= 0.0 || self.is_faded() {
            // Interpolated normals lean away from the eye at the rim of a curved mesh: there is nothing to march.
            return Some(on_polygon);
        }
        let field = self.field(heights, footprint);
        let record = match precision {
            Precision::Single => march(&field, &ray, &options),
            Precision::Oracle => truth(&field, &ray, &options),
        };
        cost.fetches += record.fetches;
        cost.iterations += record.iterations;
        record.hit.then_some(record)
    }

    /// How much of the light in `direction` the relief leaves to a point of itself. With level of detail, to what a pixel
    /// covers: shadows do not fade, they become their mean. `only`: ask one point, as one of many rays to a wide light does.
    pub(crate) fn self_shadow(
        &self,
        record: &Record,
        footprint: &Footprint,
        direction: Vec3,
        only: Option<u32>,
    ) -> f32 {
        let Some((_, heights)) = self.look.march() else { return 1.0 };
        let (field, options, kind) = (self.field(heights, footprint), self.options(), self.look.relief.shadow);
        let count = if self.look.relief.lod { footprint.points(heights.size()) } else { 1 };
        let factor = |uv: [f32; 2], depth: f32| {
            shadow(&field, kind, &self.ray_through(self.full_depth, uv, direction), depth, &options).factor
        };
        if count == 1 && !self.is_faded() {
            return factor(record.uv, record.depth);
        }
        let on_surface = |i: u32| {
            let uv = footprint.point(record.uv, i);
            factor(uv, 1.0 - field.sample(uv))
        };
        match only {
            Some(i) => on_surface(i % count),
            None => (0..count).map(on_surface).sum::<f32>() / count as f32,
        }
    }

    /// The mean normal at a displaced uv, its direction of unit length: from the normal map, else from the height map's slope,
    /// else the mesh's own.
    pub(crate) fn shading_normal(&self, uv: [f32; 2], footprint: &Footprint) -> MeanNormal {
        let look = self.look;
        let own = MeanNormal { direction: self.frame.z_axis, length: 1.0 };
        if look.is_flat() {
            return own;
        }
        let mean = if let Some(local) = look.normal(uv, footprint, self.repeat) {
            MeanNormal { direction: self.decode * local.direction, ..local }
        } else if let Some(heights) = &look.heights {
            let local = self.normal_of_heights(heights, uv, footprint);
            MeanNormal { direction: self.frame * local.direction, ..local }
        } else {
            return own;
        };
        MeanNormal { direction: mean.direction.try_normalize().unwrap_or(self.frame.z_axis), ..mean }
    }

    /// The mean normal of the height map's slopes, in the frame.
    fn normal_of_heights(&self, heights: &'a ReliefMap, uv: [f32; 2], footprint: &Footprint) -> MeanNormal {
        let size = heights.size();
        let probes = if self.look.relief.lod { footprint.probes(size) } else { Footprint::default().probes(size) };
        let field = self.look.field(heights, probes.lod, self.repeat);
        // Central difference over one texel, between levels too.
        let step = size.map(|n| 0.5 * probes.lod.exp2() / n as f32);
        // From slopes in texture space to the surface's.
        let to_gradient = self.to_uv.transpose() * self.full_depth;
        MeanNormal::of((0..probes.count).map(|i| {
            let [u, v] = probes.uv(uv, i);
            let slope = Vec2::new(
                (field.sample([u + step[0], v]) - field.sample([u - step[0], v])) / (2.0 * step[0]),
                (field.sample([u, v + step[1]]) - field.sample([u, v - step[1]])) / (2.0 * step[1]),
            );
            let gradient = to_gradient * slope;
            let [uu, vv, cross] = self.look.slope_scatter([u, v], probes.lod, self.repeat);
            let [w, h] = size.map(|n| n as f32);
            let moments = Mat2::from_cols_array(&[uu * w * w, cross * w * h, cross * w * h, vv * h * h]);
            let scatter = to_gradient * moments * to_gradient.transpose();
            let variance = 0.5 * (scatter.x_axis.x + scatter.y_axis.y).max(0.0);
            (Vec3::new(-gradient.x, -gradient.y, 1.0), MeanNormal::length_of(variance))
        }))
    }

    /// The pixel's footprint on the polygon.
    fn footprint(&self, ray: &ViewRay<'_>) -> Footprint {
        let project = |direction: Vec3| {
            let t = (self.point - ray.origin).dot(self.geometric_normal) / direction.dot(self.geometric_normal);
            let step = ray.origin + direction * t - self.point;
            let uv = self.to_uv * (self.frame.transpose() * step).truncate();
            if uv.is_finite() { uv.into() } else { [0.0; 2] }
        };
        let [dx, dy] = (ray.neighbours)().map(project);
        Footprint { dx, dy }
    }
}

/// The oracle's answer in the clothes of a record.
fn truth(field: &impl HeightField, ray: &Ray, options: &MarchOptions) -> Record {
    let lid = options.on_lid(ray);
    match oracle(field, &OracleRay::from(&lid), options.bounds) {
        Some(hit) => Record { uv: hit.uv.map(|x| x as f32), depth: hit.depth as f32, hit: true, ..Record::default() },
        None => Record { uv: ray.uv, ..Record::default() },
    }
}

impl World {
    /// The first surface along a ray, and what the marches on the way cost.
    pub(crate) fn first_surface(&self, ray: &ViewRay<'_>, precision: Precision) -> (Option<SurfacePoint<'_>>, Cost) {
        let sheared = ShearedRay::new(ray.origin, ray.direction);
        let mut cost = Cost::default();
        let mut best: Option<SurfacePoint<'_>> = None;
        self.tree.nearest(ray.origin, ray.direction, f32::INFINITY, |triangle, nearest| {
            let hit = sheared.hit(self.positions(triangle)).filter(|hit| hit.t < nearest);
            let point = hit.and_then(|hit| self.surface_at(triangle, &hit, ray, precision, &mut cost));
            match point.filter(|point| point.t < nearest && point.t >= ray.near) {
                Some(point) => best.insert(point).t,
                None => f32::INFINITY,
            }
        });
        // A relief that rises towards the eye may be nearer than what lies before its polygon.
        self.risen.nearest(ray.origin, ray.direction, f32::INFINITY, |triangle, _| {
            let hit = sheared.hit(self.positions(triangle));
            let point = hit.and_then(|hit| self.surface_at(triangle, &hit, ray, precision, &mut cost));
            let nearest = best.as_ref().map_or(f32::INFINITY, |best| best.t);
            if let Some(point) = point.filter(|point| point.t < nearest && point.t >= ray.near) {
                best = Some(point);
            }
            f32::INFINITY
        });
        (best, cost)
    }

    fn surface_at(
        &self,
        triangle: u32,
        hit: &TriangleHit,
        ray: &ViewRay<'_>,
        precision: Precision,
        cost: &mut Cost,
    ) -> Option<SurfacePoint<'_>> {
        let mut patch = Patch::new(self, triangle, hit);
        let toward = -ray.direction;
        if patch.is_displaced() && patch.geometric_normal.dot(toward) <= 0.0 {
            return None;
        }
        let footprint = if patch.look.needs_footprint { patch.footprint(ray) } else { Footprint::default() };
        let footprint = patch.fade(footprint);
        let record = patch.march(toward, &footprint, precision, cost)?;
        let mut t = hit.t;
        let mut position = patch.point;
        if patch.look.march().is_some() && patch.look.relief.writes_depth() {
            let cos = patch.frame.z_axis.dot(toward);
            if cos > 0.0 {
                t += patch.beyond_polygon(record.depth, cos);
                position = ray.origin + ray.direction * t;
            }
        }
        Some(SurfacePoint { patch, triangle, t, position, record, footprint })
    }

    /// Whether anything but the relief of `from` itself hides a light in `direction` at `distance`.
    pub(crate) fn is_hidden(
        &self,
        from: &SurfacePoint<'_>,
        among: OccluderSet,
        direction: Vec3,
        distance: f32,
    ) -> bool {
        let own = self.owner[from.triangle as usize];
        let own_is_marched = from.patch.look.march().is_some();
        let side = from.patch.geometric_normal.dot(direction).signum();
        let lift = from.patch.shadow_lift();
        if from.patch.is_displaced() && side < 0.0 && lift == 0.0 {
            // A facet that faces away from the light is its own shadow, as it is where the relief is marched.
            return true;
        }
        // Clear of the surface it starts on, in proportion to where f32 stops telling points apart.
        let extent = |point: Vec3| point.abs().max_element();
        let clearance =
            1e-5 * self.positions(from.triangle).map(extent).into_iter().fold(extent(from.position), f32::max);
        let origin = if own_is_marched {
            from.position
        } else {
            from.position + from.patch.geometric_normal * (side * clearance) + from.patch.frame.z_axis * lift
        };
        let blocks = |triangle: u32, hit: &TriangleHit| {
            let is_own = self.owner[triangle as usize] == own;
            if among == OccluderSet::Itself && !is_own {
                return false;
            }
            let (_, look) = self.thing_of(triangle);
            if look.march().is_none() {
                return hit.t < distance;
            }
            let [a, b, c] = self.positions(triangle);
            let entering = (b - a).cross(c - a).dot(direction) < 0.0;
            // A point under its own lid leaves through it; the march towards the light has dealt with that.
            if is_own && own_is_marched && (!entering || hit.t < clearance) {
                return false;
            }
            let patch = Patch::new(self, triangle, hit);
            // The relief is always marched from its front, whichever way the light goes.
            let toward = if entering { -direction } else { direction };
            let Some(record) = patch.march(toward, &Footprint::default(), Precision::Single, &mut Cost::default())
            else {
                return false;
            };
            let cos = patch.frame.z_axis.dot(toward);
            let beyond =
                if look.relief.writes_depth() && cos > 0.0 { patch.beyond_polygon(record.depth, cos) } else { 0.0 };
            let t = if entering { hit.t + beyond } else { hit.t - beyond };
            // On its way in, above a polygon whose relief rises, it has passed bumps behind it and has another one ahead.
            let t = if entering && t <= clearance { hit.t } else { t };
            t > clearance && t < distance
        };
        let ahead = ShearedRay::new(origin, direction);
        let meets = |triangle: u32| ahead.hit(self.positions(triangle)).is_some_and(|hit| blocks(triangle, &hit));
        if self.tree.any(origin, direction, distance, meets) || self.risen.any(origin, direction, f32::INFINITY, meets)
        {
            return true;
        }
        // Above the polygon of a risen relief, still among its bumps.
        let behind = ShearedRay::new(origin, -direction);
        self.risen.any(origin, -direction, f32::INFINITY, |triangle| {
            let hit = behind.hit(self.positions(triangle)).map(|hit| TriangleHit { t: -hit.t, ..hit });
            hit.is_some_and(|hit| blocks(triangle, &hit))
        })
    }

    fn positions(&self, triangle: u32) -> [Vec3; 3] {
        self.corners(triangle).map(|corner| corner.position)
    }
}

/// What may hide a light.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum OccluderSet {
    /// Anything in the scene.
    Everything,
    /// Only the object itself.
    Itself,
}
