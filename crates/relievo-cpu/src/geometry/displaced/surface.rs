use glam::Vec3;
use relievo_map::{Grid, Wrap};
use relievo_march::Bounds;
use relievo_scene::{ReliefDepth, SurfaceMesh, Vertex};

use super::base_triangle::{BaseTriangle, Displacement, depth_range};
use super::heights::{HeightRanges, Heights};
use super::local_box::{LocalBox, Shear};
use super::micro_ray::MicroRay;
use super::search::{Facing, MicroHit, Search};

/// Most micro-triangles along a side of a triangle.
const MAX_CUTS: u32 = 1 << 24;

/// Distance by which the surface may be raised or lowered, in texels.
pub(crate) const MAX_RAISE: f64 = 0.25;

/// The displaced surface of an object.
pub(crate) struct MicroSurface {
    /// Micro-triangles along a side of each triangle: a power of two.
    pub(crate) cuts: u32,
    /// Vertices per texel along the longest side, in texels of the height map.
    pub(crate) per_texel: f64,
    /// Side of a mean texel, scene units.
    pub(crate) texel: f64,
    depth: ReliefDepth,
    midlevel: f32,
    addressing: (Wrap, Option<Bounds>),
    /// The first of the object's triangles in the scene.
    first_triangle: u32,
    /// Least and greatest depth of each triangle.
    depths: Vec<[f32; 2]>,
}

/// A height map with the ranges of its blocks.
#[derive(Clone, Copy)]
pub(crate) struct RangedMap<'a> {
    pub(crate) map: &'a Grid<f32>,
    pub(crate) ranges: &'a HeightRanges,
}

impl MicroSurface {
    /// Cuts the object's `mesh` so finely that at least `per_texel` vertices stand on a texel's length along every side.
    pub(crate) fn new(
        mesh: &SurfaceMesh,
        first_triangle: u32,
        map: [u32; 2],
        depth: ReliefDepth,
        midlevel: f32,
        addressing: (Wrap, Option<Bounds>),
        per_texel: u32,
    ) -> Self {
        let longest = longest_side(mesh, map);
        let wanted = (longest * f64::from(per_texel)).ceil().clamp(1.0, f64::from(MAX_CUTS)) as u32;
        let cuts = wanted.next_power_of_two();
        let depths = mesh.triangles.iter().map(|&triangle| depth_range(corners(mesh, triangle), &depth)).collect();
        Self {
            cuts,
            per_texel: f64::from(cuts) / longest.max(f64::MIN_POSITIVE),
            texel: texel_side(mesh, map),
            depth,
            midlevel,
            addressing,
            first_triangle,
            depths,
        }
    }

    /// Returns the triangle with this number in the scene.
    fn triangle<'a>(
        &'a self,
        mesh: &'a SurfaceMesh,
        triangle: u32,
        heights: RangedMap<'a>,
        raise: f64,
    ) -> BaseTriangle<'a> {
        let relief = Displacement {
            heights: Heights::new(heights.map, heights.ranges, self.addressing),
            depth: &self.depth,
            midlevel: f64::from(self.midlevel),
            raise: raise.clamp(-MAX_RAISE, MAX_RAISE) * self.texel,
        };
        let depths = self.depths[(triangle - self.first_triangle) as usize];
        BaseTriangle::new(corners(mesh, mesh.triangles[triangle as usize]), relief, depths, self.cuts)
    }

    /// Returns a box around a triangle's part of the surface, wherever it is raised or lowered to: least and greatest corner.
    pub(crate) fn bounds(&self, mesh: &SurfaceMesh, triangle: u32, heights: RangedMap<'_>) -> [Vec3; 2] {
        let mut around: Option<LocalBox> = None;
        for raise in [-MAX_RAISE, MAX_RAISE] {
            let triangle = self.triangle(mesh, triangle, heights, raise);
            let corners = triangle.base_corners().map(|w| triangle.corner(&glam::DMat3::IDENTITY, w));
            let part = triangle.around(&corners, triangle.n(), Shear::NONE);
            let (min, max) = (part.min + triangle.centre(), part.max + triangle.centre());
            around =
                Some(around.map_or(LocalBox { min, max }, |other| LocalBox {
                    min: min.min(other.min),
                    max: max.max(other.max),
                }));
        }
        around.map_or([Vec3::ZERO; 2], |around| [around.min.as_vec3(), around.max.as_vec3()])
    }

    /// Returns the point where a ray first meets the surface over a triangle, nearer than `limit`. `raise` moves the surface
    /// along its normals, in texels.
    pub(crate) fn hit(
        &self,
        mesh: &SurfaceMesh,
        triangle: u32,
        heights: RangedMap<'_>,
        raise: f64,
        ray: &MicroRay,
        limit: f64,
        facing: Facing,
    ) -> Option<MicroHit> {
        Search::first(&self.triangle(mesh, triangle, heights, raise), ray, limit, facing)
    }
}

fn corners(mesh: &SurfaceMesh, triangle: [u32; 3]) -> [&Vertex; 3] {
    triangle.map(|i| &mesh.vertices[i as usize])
}

/// Returns the longest side of any triangle along u or v, in texels.
fn longest_side(mesh: &SurfaceMesh, map: [u32; 2]) -> f64 {
    let sides = mesh.triangles.iter().flat_map(|&triangle| {
        let [a, b, c] = corners(mesh, triangle).map(|corner| corner.uv.as_dvec2());
        [b - a, c - b, a - c]
    });
    sides.map(|side| (side.x.abs() * f64::from(map[0])).max(side.y.abs() * f64::from(map[1]))).fold(1.0, f64::max)
}

/// Returns the side of a square of a texel's mean area, scene units; 0 where there is none.
fn texel_side(mesh: &SurfaceMesh, map: [u32; 2]) -> f64 {
    let (mut area, mut texels) = (0.0, 0.0);
    for &triangle in &mesh.triangles {
        let corners = corners(mesh, triangle);
        let [a, b, c] = corners.map(|corner| corner.position.as_dvec3());
        let [d, e, f] = corners.map(|corner| corner.uv.as_dvec2());
        area += (b - a).cross(c - a).length();
        texels += (e - d).perp_dot(f - d).abs() * f64::from(map[0]) * f64::from(map[1]);
    }
    let side = (area / texels).sqrt();
    if side.is_finite() { side } else { 0.0 }
}
