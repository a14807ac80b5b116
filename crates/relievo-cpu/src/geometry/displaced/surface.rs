use glam::Vec3;
use relievo_map::{Grid, Wrap};
use relievo_scene::{Relief, ReliefDepth, SurfaceMesh, Vertex};

use super::base_triangle::{BaseTriangle, DepthRange, Displacement, depth_range};
use super::filtered_map::{FilteredMap, HeightRanges};
use super::local_box::{LocalBox, Shear};
use super::micro_ray::MicroRay;
use super::search::{MicroHit, Search, Sides};

/// Most micro-triangles along a side of a triangle.
const MAX_CUTS: u32 = 1 << 24;

/// Distance by which the surface may be raised or lowered, in texels.
pub(crate) const MAX_RAISE: f64 = 0.25;

/// The relief of an object whose displaced surface is traced.
#[derive(Clone, Copy)]
pub(crate) struct TracedRelief {
    /// Texels of the height map along u and v.
    pub(crate) map: [u32; 2],
    pub(crate) depth: ReliefDepth,
    pub(crate) midlevel: f32,
    pub(crate) wrap: Wrap,
    /// True if texels are columns.
    pub(crate) nearest: bool,
    /// Its settings, which say where it ends.
    pub(crate) relief: Relief,
    /// Vertices along a texel's length, at least.
    pub(crate) per_texel: u32,
}

/// The displaced surface of an object.
pub(crate) struct MicroSurface {
    /// Micro-triangles along a side of each triangle: a power of two.
    pub(crate) cuts: u32,
    /// Vertices per texel along the longest side, in texels of the height map.
    pub(crate) per_texel: f64,
    /// Side of a mean texel, scene units.
    pub(crate) texel: f64,
    traced: TracedRelief,
    /// The first of the object's triangles in the scene.
    first_triangle: u32,
    /// Bounds of the depth over each triangle.
    depths: Vec<[f32; 2]>,
    /// The depth, where it is the same everywhere.
    uniform_depth: Option<f64>,
}

/// A height map with the ranges of its blocks.
#[derive(Clone, Copy)]
pub(crate) struct RangedMap<'a> {
    pub(crate) map: &'a Grid<f32>,
    pub(crate) ranges: &'a HeightRanges,
}

impl MicroSurface {
    /// Cuts the object's `mesh` as finely as the relief asks for.
    pub(crate) fn new(mesh: &SurfaceMesh, first_triangle: u32, traced: TracedRelief) -> Self {
        let TracedRelief { map, depth, per_texel, .. } = traced;
        let longest = longest_side(mesh, map);
        let wanted = (longest * f64::from(per_texel)).ceil().clamp(1.0, f64::from(MAX_CUTS)) as u32;
        let cuts = wanted.next_power_of_two();
        let depths: Vec<[f32; 2]> =
            mesh.triangles.iter().map(|&triangle| depth_range(corners(mesh, triangle), &depth)).collect();
        let least = depths.iter().map(|range| range[0]).fold(f32::INFINITY, f32::min);
        let most = depths.iter().map(|range| range[1]).fold(0.0, f32::max);
        // Closer together than rounding tells apart.
        let uniform_depth = (!(most - least > 1e-6 * most)).then_some(f64::from(most));
        Self {
            cuts,
            per_texel: f64::from(cuts) / longest.max(f64::MIN_POSITIVE),
            texel: texel_side(mesh, map),
            traced,
            first_triangle,
            depths,
            uniform_depth,
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
        let traced = &self.traced;
        let range = mesh.chart(triangle as usize).bounds();
        let addressing = traced.relief.addressing(traced.wrap, range);
        let relief = Displacement {
            heights: FilteredMap::new(heights.map, heights.ranges, traced.nearest, addressing),
            depth: &traced.depth,
            midlevel: f64::from(traced.midlevel),
            raise: raise.clamp(-MAX_RAISE, MAX_RAISE) * self.texel,
            bounds: traced.relief.ends_at(range),
        };
        let bounds = self.depths[(triangle - self.first_triangle) as usize];
        let depth = self.uniform_depth.map_or(DepthRange::Between(bounds), DepthRange::Uniform);
        BaseTriangle::new(corners(mesh, mesh.triangles[triangle as usize]), relief, depth, self.cuts)
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
        sides: Sides,
    ) -> Option<MicroHit> {
        Search::first(&self.triangle(mesh, triangle, heights, raise), ray, limit, sides)
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

#[cfg(test)]
mod tests {
    use glam::{DVec3, Mat3, Vec2, Vec4};
    use relievo_scene::{Chart, Face, HeightRange};

    use super::*;

    const SIDE: u32 = 3;

    /// Uneven triangles on a smooth hill, with uvs that change their density. The middle row of faces has vertices of its own,
    /// in another order, as behind a seam.
    fn hill() -> SurfaceMesh {
        let n = SIDE + 2;
        let vertex = |i: u32, j: u32| {
            let (x, y) = (i as f32 / n as f32 * 2.0 - 1.0, j as f32 / n as f32 * 2.0 - 1.0);
            let bend = 0.06 * ((3 * i + 5 * j) as f32).sin();
            Vertex {
                position: Vec3::new(x + bend, y - bend, 0.4 * (2.0 * x).sin() * y),
                normal: Vec3::new(-0.8 * (2.0 * x).cos() * y, -0.4 * (2.0 * x).sin(), 1.0).normalize(),
                tangent: Vec4::new(1.0, 0.0, 0.0, 1.0),
                uv: Vec2::new(i as f32 / 4.0, (j * j) as f32 / 16.0),
                direction: Vec3::new(-0.8 * (2.0 * x).cos() * y, -0.4 * (2.0 * x).sin(), 1.0).normalize(),
                repeat_length: 1.0,
            }
        };
        let chart = Chart { repeat_length: 1.0, min: Vec2::ZERO, max: Vec2::ONE, is_rectangle: false, is_flat: false };
        let face = Face { dp_du: Vec3::X, dp_dv: Vec3::Y, chart: 0 };
        let mut mesh = SurfaceMesh { faces: vec![face], charts: vec![chart], ..SurfaceMesh::default() };
        for j in 0..n {
            for i in 0..n {
                let first = mesh.vertices.len() as u32;
                mesh.vertices.extend([vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)]);
                mesh.triangles.extend([[first, first + 1, first + 2], [first + 2, first + 3, first]]);
                mesh.face_of.extend([0; 2]);
            }
        }
        mesh
    }

    fn surface(mesh: &SurfaceMesh, range: HeightRange, per_texel: u32) -> MicroSurface {
        let depth = ReliefDepth { range, transposed: Mat3::IDENTITY };
        MicroSurface::new(
            mesh,
            0,
            TracedRelief {
                map: [16; 2],
                depth,
                midlevel: 0.6,
                wrap: Wrap::Mirror,
                nearest: false,
                relief: Relief::default(),
                per_texel,
            },
        )
    }

    fn rough() -> Grid<f32> {
        Grid::from_fn(16, 16, |x, y| ((x * 977 + y * 331) % 64) as f32 / 63.0)
    }

    #[test]
    fn no_ray_slips_through_an_edge_or_a_vertex() {
        let mesh = hill();
        let map = rough();
        let ranges = HeightRanges::build(&map);
        let heights = RangedMap { map: &map, ranges: &ranges };
        let mut rays = 0;
        for (range, per_texel) in [(HeightRange::Depth(0.05), 1), (HeightRange::Scale(0.04), 4)] {
            let surface = surface(&mesh, range, per_texel);
            let n = surface.cuts;
            for index in 0..mesh.triangles.len() as u32 {
                let [column, row] = [index / 2 % (SIDE + 2), index / 2 / (SIDE + 2)];
                if ![column, row].iter().all(|k| (1..=SIDE).contains(k)) {
                    // Beside the border of the whole there is nothing.
                    continue;
                }
                let triangle = surface.triangle(&mesh, index, heights, 0.0);
                for k in 0..2800u32 {
                    // Points of the edges, and between the vertices that stand on them; every seventh a vertex.
                    let along = k * 37 % n;
                    let mut weights = [0; 3];
                    let side = (k % 3) as usize;
                    (weights[side], weights[(side + 1) % 3]) = (n - along, along);
                    let mut next = weights;
                    (next[side], next[(side + 1) % 3]) = (n - along - 1, along + 1);
                    let part = if k % 7 == 0 { 0.0 } else { f64::from(k % 101) / 101.0 };
                    let target = triangle.point(weights).lerp(triangle.point(next), part);
                    let lean = f64::from(k % 61) / 61.0 - 0.5;
                    let origin = target + DVec3::new(0.9 * lean, 0.4 * lean - 0.1, 3.0);
                    let ray = MicroRay::through(origin, target - origin);
                    let meets = |index: u32| surface.hit(&mesh, index, heights, 0.0, &ray, 2.0, Sides::Any).is_some();
                    assert!((0..mesh.triangles.len() as u32).any(meets), "triangle {index}, ray {k}");
                    rays += 1;
                }
            }
        }
        assert!(rays >= 100_000, "{rays}");
    }

    #[test]
    fn a_search_finds_the_first_of_all_micro_triangles() {
        let mesh = hill();
        let map = rough();
        let ranges = HeightRanges::build(&map);
        let heights = RangedMap { map: &map, ranges: &ranges };
        for (range, raise) in [(HeightRange::Depth(0.3), 0.0), (HeightRange::Scale(0.4), 0.2)] {
            let surface = surface(&mesh, range, 2);
            let mut found = 0;
            for index in [0u32, 11, 24, 49] {
                let triangle = surface.triangle(&mesh, index, heights, raise);
                let n = surface.cuts;
                let centre =
                    (0..3).map(|k| mesh.vertices[mesh.triangles[index as usize][k] as usize].position).sum::<Vec3>()
                        / 3.0;
                for k in 0..40 {
                    let (a, b) = ((k as f32 * 2.4).sin(), (k as f32 * 1.7).cos());
                    let target = centre + Vec3::new(a, b, 0.0) * 0.1;
                    let origin = centre + Vec3::new(1.2 * b, 1.5 * a, 0.2 + 0.05 * k as f32);
                    let ray = MicroRay::new(origin, target - origin, 0.0);
                    let mut first = f64::INFINITY;
                    for i in 0..n {
                        for j in 0..n - i {
                            let at = |i: u32, j: u32| triangle.point([n - i - j, i, j]);
                            let mut meet = |corners: [DVec3; 3]| {
                                first = ray.hit(corners).map_or(first, |(t, _)| first.min(t));
                            };
                            meet([at(i, j), at(i + 1, j), at(i, j + 1)]);
                            if i + j + 2 <= n {
                                meet([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                            }
                        }
                    }
                    let nearest = |sides| surface.hit(&mesh, index, heights, raise, &ray, f64::INFINITY, sides);
                    assert_eq!(nearest(Sides::Any).is_some(), first < f64::INFINITY);
                    let [front, any] = [Sides::Front, Sides::Any].map(|sides| nearest(sides).map(|hit| hit.t));
                    assert!(front.is_none_or(|t| t > first - 1e-12) && any.is_none_or(|t| t > first - 1e-12));
                    // Seen from above, the first one shows its front.
                    if let Some(front) = front.filter(|_| first < f64::INFINITY) {
                        found += usize::from((front - first).abs() < 1e-12);
                    }
                }
            }
            assert!(found > 60, "{found}");
        }
    }
}
