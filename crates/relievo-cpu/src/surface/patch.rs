use glam::{Mat2, Mat3, Vec2, Vec3};
use relievo_march::{
    Bounds, ColumnWall, Footprint, HeightField, MarchOptions, ObjectField, OracleRay, Ray, Record, ReliefMap, Shadow,
    SurfaceAxes, march_from, oracle_from, shadow_up_to,
};
use relievo_scene::{MarchSpace, ShadingModel, Vertex};

use super::view_ray::{MarchCost, ViewRay};
use crate::Precision;
use crate::geometry::{TriangleHit, World};
use crate::shading::material::MaterialShading;
use crate::shading::material_sample::MaterialSample;
use crate::shading::mean_normal::MeanNormal;

/// The height above the surface at which a shadow ray starts, as a fraction of the full depth.
const SHELL_LIFT: f32 = 1e-4;

/// The distance within which hits in a shell are known, in texels: how far its chords are from the ray.
const SHELL_ERROR: f32 = 1e-3;

/// The texture repeats beyond the end of a relief up to which displaced geometry is not cut off, relative to uv + 1.
const CUT_SLACK: f32 = 1e-6;

/// A polygon where a ray crosses it, with the frame in which its relief is marched.
pub(crate) struct Patch<'a> {
    pub(crate) material: &'a MaterialShading,
    /// Texture range of the chart.
    range: Bounds,
    /// In texture repeats.
    pub(crate) uv: Vec2,
    pub(crate) point: Vec3,
    /// Normal of the flat triangle, towards its front; unit length.
    pub(crate) geometric_normal: Vec3,
    /// Tangent, bitangent and normal as interpolated, not normalised: the inverse of how normal maps are baked (MikkTSpace).
    decode: Mat3,
    /// The same, orthonormal.
    pub(super) frame: Mat3,
    /// The flat triangle's uv axes and the interpolated normal, in which the relief is marched.
    axes: SurfaceAxes,
    /// (dP/du, dP/dv)⁻¹ in the frame: from scene units to texture repeats.
    to_uv: Mat2,
    /// Distance between height 0 and 1 as it is marched, scene units: less than `full_depth` where level of detail fades the
    /// relief to its polygon.
    depth: f32,
    full_depth: f32,
    in_shell: bool,
}

impl<'a> Patch<'a> {
    pub(super) fn new(world: &'a World, triangle: u32, hit: &TriangleHit) -> Self {
        let (instance, material) = world.instance_of(triangle);
        let corners = world.corners(triangle);
        let face = world.surface_mesh.face(triangle as usize);
        let [a, b, c] = corners.map(|corner| corner.position);
        let vertex = Vertex::interpolate(corners, hit.weights);
        let tangent = vertex.tangent.truncate();
        let bitangent = vertex.normal.cross(tangent) * vertex.tangent.w;
        let normal = vertex.normal.normalize_or_zero();
        let along_u = (tangent - normal * normal.dot(tangent)).try_normalize();
        let along_u = along_u.unwrap_or_else(|| normal.any_orthonormal_vector());
        let frame = Mat3::from_cols(along_u, normal.cross(along_u) * vertex.tangent.w, normal);
        let axes = SurfaceAxes {
            dp_du: face.dp_du.into(),
            dp_dv: face.dp_dv.into(),
            normal: vertex.direction.normalize_or_zero().into(),
        };
        Self {
            material,
            range: world.range(triangle),
            uv: vertex.uv,
            point: vertex.position,
            geometric_normal: (b - a).cross(c - a).normalize_or_zero(),
            decode: Mat3::from_cols(tangent, bitangent, vertex.normal),
            to_uv: to_uv(&frame, [face.dp_du, face.dp_dv]),
            axes,
            frame,
            depth: instance.depth.at(&vertex),
            full_depth: instance.depth.at(&vertex),
            in_shell: instance.space == MarchSpace::Shell,
        }
    }

    /// Fades the depth that a pixel of this footprint cannot resolve; returns the footprint on the faded relief.
    pub(super) fn fade(&mut self, footprint: Footprint) -> Footprint {
        let Some((_, heights)) = self.material.march().filter(|_| self.material.relief.lod) else {
            return footprint;
        };
        let fade = footprint.fade(heights.size(), (self.to_uv.x_axis * self.full_depth).into());
        self.depth = self.full_depth * fade;
        footprint.on_relief(heights.size(), fade)
    }

    /// Returns the fraction of the depth that level of detail keeps.
    pub(super) fn kept_depth(&self) -> f32 {
        if self.full_depth > 0.0 { self.depth / self.full_depth } else { 0.0 }
    }

    /// Returns the record of the point on the polygon itself.
    pub(super) fn on_polygon(&self) -> Record {
        Record { uv: self.uv.into(), depth: 1.0 - self.material.midlevel, hit: true, ..Record::default() }
    }

    /// Returns the depth below the height 1 of a point of the relief over a point of the polygon.
    pub(super) fn depth_at(&self, point: Vec3, on_polygon: Vec3) -> f32 {
        let offset = (point - on_polygon).dot(self.axes.normal.into());
        let depth = (1.0 - self.material.midlevel) - offset / self.full_depth;
        if depth.is_finite() { depth } else { 1.0 - self.material.midlevel }
    }

    /// Returns true if displaced geometry has a part here that lies beyond the texture range in which its relief ends.
    pub(super) fn is_cut_off(&self) -> bool {
        let bounds = self.material.relief.ends_at(self.range).filter(|_| self.is_displaced());
        // Rounding must not cut a chart that ends there by itself.
        let beyond = |bounds: Bounds| {
            (0..2).any(|k| {
                let slack = CUT_SLACK * (1.0 + self.uv[k].abs());
                self.uv[k] < bounds.min[k] - slack || self.uv[k] > bounds.max[k] + slack
            })
        };
        bounds.is_some_and(beyond)
    }

    /// Returns true if level of detail has faded the relief's depth to 0.
    fn is_faded(&self) -> bool {
        self.depth < self.full_depth && self.depth == 0.0
    }

    /// Returns the ray along `outward` (unit length, scene space, away from the surface) in texture space, through `uv`.
    pub(crate) fn ray(&self, uv: [f32; 2], outward: Vec3) -> Ray {
        self.ray_through(self.depth, uv, outward)
    }

    fn ray_through(&self, depth: f32, uv: [f32; 2], outward: Vec3) -> Ray {
        Ray::from_surface(uv, outward.into(), &self.axes, depth)
    }

    /// Returns true if the relief is real geometry.
    pub(super) fn is_displaced(&self) -> bool {
        self.material.is_displaced()
    }

    /// Returns true if the relief is real geometry that is not kept.
    pub(super) fn is_micro(&self) -> bool {
        self.is_displaced() && self.material.relief.vertices_per_texel.is_some()
    }

    /// Returns the height above displaced geometry at which shadow rays start, scene units: over the terraces of an 8-bit
    /// map, as where it is marched.
    pub(super) fn shadow_lift(&self) -> f32 {
        match &self.material.heights {
            Some(heights) if self.is_displaced() => self.depth * heights.quantization_step(),
            _ => 0.0,
        }
    }

    /// Returns the way from a hit in a shell to where its shadow rays start, scene units: clear of what is known of the hit and of
    /// the way to the light, of the terraces of an 8-bit map, and off the wall of a column.
    pub(super) fn shell_clearance(&self, record: &Record) -> Vec3 {
        let up = self.frame.z_axis * self.material.heights.as_ref().map_or(0.0, |heights| self.shell_lift(heights));
        let Some(wall) = self.wall(record) else { return up };
        let [u, v] = [0, 1].map(|k| wall.beside[k] - record.uv[k]);
        up + Vec3::from(self.axes.dp_du) * u + Vec3::from(self.axes.dp_dv) * v
    }

    /// Returns the height above a relief in a shell at which shadow rays start, scene units.
    fn shell_lift(&self, heights: &ReliefMap) -> f32 {
        let [low, high] = heights.range();
        let [width, height] = heights.size().map(|n| n as f32);
        let texel = (Vec3::from(self.axes.dp_du).length() / width).min(Vec3::from(self.axes.dp_dv).length() / height);
        // Both are known to this part of a texel along u, along v and in height; heights change from texel to texel by the map's
        // range at most.
        let known = SHELL_ERROR * (2.0 * (high - low) * self.full_depth + texel);
        2.0 * known + self.full_depth * (SHELL_LIFT + heights.quantization_step())
    }

    /// Returns the march options of the relief on this patch.
    pub(crate) fn options(&self) -> MarchOptions {
        self.material.relief.march(self.material.midlevel, self.range)
    }

    /// Returns all maps but the normal at a displaced uv.
    pub(crate) fn material_sample(&self, uv: [f32; 2], footprint: &Footprint, model: ShadingModel) -> MaterialSample {
        self.material.sample(uv, footprint, self.range, model)
    }

    /// Returns the height map at the level of detail that suits the footprint.
    pub(crate) fn field(&self, heights: &'a ReliefMap, footprint: &Footprint) -> ObjectField<'a> {
        let lod = if self.material.relief.lod { footprint.march_lod(heights.size()) } else { 0.0 };
        self.material.field(heights, lod, self.range)
    }

    /// Returns the depth of the point of a ray that lies this far before the polygon; 0 at and above the lid.
    fn depth_at_origin(&self, before: f32, cos: f32) -> f32 {
        // `max` also turns a depth of 0 into 0.
        ((1.0 - self.material.midlevel) - before * cos / self.depth).max(0.0)
    }

    /// Returns the distance along a ray with this cosine between the polygon and a march's `depth`.
    pub(super) fn beyond_polygon(&self, depth: f32, cos: f32) -> f32 {
        (depth - (1.0 - self.material.midlevel)) * self.depth / cos
    }

    /// Marches along `outward` (away from the surface) a ray that begins this far before the polygon: maybe below the lid.
    /// Returns the cosine of the march too. `None` where the relief was missed, or is seen from behind.
    pub(super) fn march(
        &self,
        outward: Vec3,
        before: f32,
        footprint: &Footprint,
        precision: Precision,
        cost: &mut MarchCost,
    ) -> Option<(Record, f32)> {
        let on_polygon = self.on_polygon();
        let options = self.options();
        let Some((_, heights)) = self.material.march() else {
            return Some((on_polygon, 0.0));
        };
        if self.geometric_normal.dot(outward) <= 0.0 {
            return None;
        }
        let ray = self.ray(self.uv.into(), outward);
        if self.is_faded() {
            return Some((on_polygon, ray.cos));
        }
        let field = self.field(heights, footprint);
        let record = match precision {
            Precision::Single => march_from(&field, &ray, &options, self.depth_at_origin(before, ray.cos)),
            Precision::Oracle => oracle_record(&field, &ray, &options, self.depth_at_origin(before, ray.cos)),
        };
        cost.fetches += record.fetches;
        cost.iterations += record.iterations;
        record.hit.then_some((record, ray.cos))
    }

    /// Returns the way to a light in full depths. Where depth is not written lights are seen from the polygon.
    fn light_reach(&self, record: &Record, direction: Vec3, distance: f32) -> f32 {
        let (reach, cos) = (distance / self.full_depth, self.ray([0.0; 2], direction).cos);
        if self.material.relief.writes_depth() || cos <= 0.0 {
            return reach;
        }
        reach + (record.depth - (1.0 - self.material.midlevel)) / cos
    }

    /// Returns the fraction of the light in `direction`, at `distance`, that the relief lets through to a point of itself;
    /// with level of detail, the mean over the pixel: shadows do not fade. `only`: a single point, as one of many rays to a
    /// wide light.
    pub(crate) fn self_shadow(
        &self,
        record: &Record,
        footprint: &Footprint,
        direction: Vec3,
        distance: f32,
        only: Option<u32>,
    ) -> f32 {
        let Some((_, heights)) = self.material.march() else { return 1.0 };
        if self.in_shell && self.material.relief.shadow == Shadow::Exact {
            // The shells themselves are asked, with everything else.
            return 1.0;
        }
        let (field, options, kind) = (self.field(heights, footprint), self.options(), self.material.relief.shadow);
        let count = if self.material.relief.lod { footprint.points(heights.size()) } else { 1 };
        let reach = self.light_reach(record, direction, distance);
        let factor = |uv: [f32; 2], depth: f32| {
            let ray = self.ray_through(self.full_depth, uv, direction);
            shadow_up_to(&field, kind, &ray, depth, reach, &options).factor
        };
        if count == 1 && !self.is_faded() {
            let uv = self.wall(record).map_or(record.uv, |wall| wall.beside);
            return factor(uv, record.depth);
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

    /// Returns true if what is seen are the columns of a nearest-filtered map themselves.
    fn shows_columns(&self) -> bool {
        let shows_heights = self.material.march().is_some() || self.is_micro();
        shows_heights && self.material.heights.as_ref().is_some_and(|heights| heights.is_sampled_nearest())
    }

    /// Returns the wall between columns of a nearest-filtered map that a point of the relief lies on.
    pub(super) fn wall(&self, record: &Record) -> Option<ColumnWall> {
        let heights = self.material.heights.as_ref().filter(|_| self.shows_columns())?;
        ColumnWall::at(&self.material.field(heights, 0.0, self.range), record.uv, record.depth)
    }

    /// Returns the normal of a wall, scene space: at right angles to the mesh's own.
    pub(super) fn wall_normal(&self, wall: &ColumnWall) -> Vec3 {
        let along = self.to_uv.transpose() * Vec2::from(wall.outward);
        (self.frame * along.extend(0.0)).try_normalize().unwrap_or(self.frame.z_axis)
    }

    /// Returns the mean normal at a point of the relief, its direction of unit length: that of a column's wall, else from the
    /// normal map, else from the slopes of the height map, else the mesh's own.
    pub(crate) fn shading_normal(&self, record: &Record, footprint: &Footprint) -> MeanNormal {
        let (material, uv) = (self.material, record.uv);
        let own = MeanNormal { direction: self.frame.z_axis, length: 1.0 };
        if material.is_flat() {
            return own;
        }
        if let Some(wall) = self.wall(record) {
            return MeanNormal { direction: self.wall_normal(&wall), ..own };
        }
        let mean = if let Some(local) = material.normal(uv, footprint, self.range) {
            MeanNormal { direction: self.decode * local.direction, ..local }
        } else if let Some(heights) = material.heights.as_ref().filter(|_| !self.shows_columns()) {
            let local = self.normal_of_heights(heights, uv, footprint);
            MeanNormal { direction: self.frame * local.direction, ..local }
        } else {
            return own;
        };
        MeanNormal { direction: mean.direction.try_normalize().unwrap_or(self.frame.z_axis), ..mean }
    }

    /// Returns the mean normal of the height map's slopes, in the frame.
    fn normal_of_heights(&self, heights: &'a ReliefMap, uv: [f32; 2], footprint: &Footprint) -> MeanNormal {
        let size = heights.size();
        let probes = if self.material.relief.lod { footprint.probes(size) } else { Footprint::default().probes(size) };
        let field = self.material.field(heights, probes.lod, self.range);
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
            let [uu, vv, cross] = self.material.slope_scatter([u, v], probes.lod, self.range);
            let [w, h] = size.map(|n| n as f32);
            let moments = Mat2::from_cols_array(&[uu * w * w, cross * w * h, cross * w * h, vv * h * h]);
            let scatter = to_gradient * moments * to_gradient.transpose();
            let variance = 0.5 * (scatter.x_axis.x + scatter.y_axis.y).max(0.0);
            (Vec3::new(-gradient.x, -gradient.y, 1.0), MeanNormal::length_of(variance))
        }))
    }

    /// Returns the pixel's footprint on the polygon.
    pub(super) fn footprint(&self, ray: &ViewRay<'_>) -> Footprint {
        let project = |[origin, direction]: [Vec3; 2]| {
            let t = (self.point - origin).dot(self.geometric_normal) / direction.dot(self.geometric_normal);
            let step = origin + direction * t - self.point;
            let uv = self.to_uv * (self.frame.transpose() * step).truncate();
            if uv.is_finite() { uv.into() } else { [0.0; 2] }
        };
        let [dx, dy] = (ray.neighbours)().map(project);
        Footprint { dx, dy }
    }
}

/// Returns the map from scene units in a frame to texture repeats, where dP/du and dP/dv are these; 0 where they are
/// degenerate.
fn to_uv(frame: &Mat3, axes: [Vec3; 2]) -> Mat2 {
    let [du, dv] = axes.map(|axis| Vec2::new(frame.x_axis.dot(axis), frame.y_axis.dot(axis)));
    let to_uv = Mat2::from_cols(du, dv).inverse();
    if to_uv.is_finite() { to_uv } else { Mat2::ZERO }
}

/// Marches with the f64 oracle, from the depth `entry` on.
fn oracle_record(field: &impl HeightField, ray: &Ray, options: &MarchOptions, entry: f32) -> Record {
    let lid = options.on_lid(ray);
    match oracle_from(field, &OracleRay::from(&lid), options.bounds, f64::from(entry)) {
        Some(hit) => Record { uv: hit.uv.map(|x| x as f32), depth: hit.depth as f32, hit: true, ..Record::default() },
        None => Record { uv: ray.uv, ..Record::default() },
    }
}
