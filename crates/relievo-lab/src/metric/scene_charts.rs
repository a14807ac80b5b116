//! Feet of displaced points on their meshes.

use std::collections::HashMap;

use glam::{DVec2, DVec3};
use relievo_cpu::VisiblePoint;
use relievo_scene::{Edge, Scene, SurfaceMesh, Vertex};

/// Most triangles that a uv is followed over.
const MAX_STEPS: usize = 1 << 12;

/// The meshes of a scene's reliefs, as charts: from uv to points in space.
pub(crate) struct SceneCharts {
    /// `None` where the object has no height map.
    objects: Vec<Option<ObjectChart>>,
}

/// The mesh of an object, with the neighbours across edges on both sides of which uv goes on.
struct ObjectChart {
    mesh: SurfaceMesh,
    /// For each triangle, the neighbour across the edge opposite each corner.
    neighbours: Vec<[Option<u32>; 3]>,
    /// Texels of the height map in a repeat, along u and v.
    texels: DVec2,
    /// True if the relief covers the whole polygon by definition, even where displaced geometry would end before.
    goes_on: bool,
}

/// The point of a mesh below or above a point of its relief.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Foot {
    point: DVec3,
    /// A texel along u and along v there, scene units.
    texel: [DVec3; 2],
    /// True if the relief goes on beyond its mesh: what is shown where displaced geometry ends is not wrong.
    pub(crate) goes_on: bool,
}

impl SceneCharts {
    /// Makes the charts of all objects with a height map.
    pub(crate) fn new(scene: &Scene) -> Self {
        let objects = scene.objects.iter().map(|object| {
            let material = &scene.materials[object.material];
            let heights = material.maps.height.as_ref()?.grid();
            let mesh = SurfaceMesh::in_scene_space(object, material);
            let neighbours = neighbours(&mesh);
            let texels = DVec2::new(f64::from(heights.width()), f64::from(heights.height()));
            let edge = scene.materials[object.material].relief.edge;
            let goes_on = matches!(edge, Edge::Wrap | Edge::Clamp);
            Some(ObjectChart { mesh, neighbours, texels, goes_on })
        });
        Self { objects: objects.collect() }
    }

    /// Returns the foot of a point, from the texture coordinates that it shows; `None` if its object has no relief.
    ///
    /// A march finds them on the polygon that its ray meets, even where they lie beyond it: from there they are followed over
    /// the mesh, as far as its uv goes on.
    pub(crate) fn foot(&self, point: &VisiblePoint) -> Option<Foot> {
        let chart = self.objects.get(point.object as usize)?.as_ref()?;
        let uv = DVec2::new(f64::from(point.uv[0]), f64::from(point.uv[1]));
        Some(chart.foot(point.triangle, uv))
    }
}

impl ObjectChart {
    fn corners(&self, triangle: u32) -> [&Vertex; 3] {
        self.mesh.triangles[triangle as usize].map(|i| &self.mesh.vertices[i as usize])
    }

    /// Returns the weights of a triangle's corners that give `uv`, which may lie outside.
    fn weights(&self, triangle: u32, uv: DVec2) -> [f64; 3] {
        let [a, b, c] = self.corners(triangle).map(|corner| corner.uv.as_dvec2());
        let area = (b - a).perp_dot(c - a);
        let (w1, w2) = ((uv - a).perp_dot(c - a) / area, (b - a).perp_dot(uv - a) / area);
        let weights = [1.0 - w1 - w2, w1, w2];
        // A triangle without area in uv shows one colour all over.
        if weights.iter().all(|w| w.is_finite()) { weights } else { [1.0 / 3.0; 3] }
    }

    fn foot(&self, start: u32, uv: DVec2) -> Foot {
        let mut triangle = start;
        let mut weights = self.weights(triangle, uv);
        for _ in 0..MAX_STEPS {
            let outermost = (1..3).fold(0, |least, k| if weights[k] < weights[least] { k } else { least });
            if weights[outermost] >= 0.0 {
                break;
            }
            let Some(next) = self.neighbours[triangle as usize][outermost] else { break };
            let there = self.weights(next, uv);
            // The corner that the neighbour does not share: on a mesh that is mirrored in uv it lies on this side.
            let across = (0..3).find(|&k| self.neighbours[next as usize][k] == Some(triangle));
            if !across.is_some_and(|k| there[k] > 0.0) {
                break;
            }
            (triangle, weights) = (next, there);
        }
        let corners = self.corners(triangle);
        let point = (0..3).map(|k| corners[k].position.as_dvec3() * weights[k]).sum();
        let [a, b, c] = corners;
        let (e1, e2) = (b.position.as_dvec3() - a.position.as_dvec3(), c.position.as_dvec3() - a.position.as_dvec3());
        let (d1, d2) = (b.uv.as_dvec2() - a.uv.as_dvec2(), c.uv.as_dvec2() - a.uv.as_dvec2());
        let area = d1.perp_dot(d2);
        let texel =
            [(e1 * d2.y - e2 * d1.y) / (area * self.texels.x), (e2 * d1.x - e1 * d2.x) / (area * self.texels.y)];
        Foot { point, texel, goes_on: self.goes_on }
    }
}

impl Foot {
    /// Returns the distance of another foot in texels of this one's surface: along its plane in its own texels, off the plane
    /// in sides of a square of their area.
    pub(crate) fn texels_to(&self, other: &Self) -> f64 {
        let offset = other.point - self.point;
        let [u, v] = self.texel;
        let normal = u.cross(v);
        let squared = normal.length_squared();
        let along = [offset.cross(v).dot(normal) / squared, u.cross(offset).dot(normal) / squared];
        let off = offset.dot(normal) / squared.powf(0.75);
        let texels = DVec3::new(along[0], along[1], off).length();
        // Where a texel has no size, nothing but the same point is right.
        if texels.is_finite() {
            texels
        } else if offset == DVec3::ZERO {
            0.0
        } else {
            f64::INFINITY
        }
    }
}

/// Returns for each triangle the neighbour across the edge opposite each corner, if position and uv go on there.
fn neighbours(mesh: &SurfaceMesh) -> Vec<[Option<u32>; 3]> {
    let mut ids: HashMap<[u32; 5], u32> = HashMap::new();
    // Vertices that are split for their normals alone are one; + 0 makes one zero of two.
    let key = |v: &Vertex| [v.position.x, v.position.y, v.position.z, v.uv.x, v.uv.y].map(|x| (x + 0.0).to_bits());
    let vertices: Vec<u32> = mesh
        .vertices
        .iter()
        .map(|vertex| {
            let next = ids.len() as u32;
            *ids.entry(key(vertex)).or_insert(next)
        })
        .collect();
    let mut neighbours = vec![[None; 3]; mesh.triangles.len()];
    let mut open: HashMap<[u32; 2], (u32, usize)> = HashMap::new();
    for (triangle, corners) in mesh.triangles.iter().enumerate() {
        for k in 0..3 {
            let [a, b] = [(k + 1) % 3, (k + 2) % 3].map(|k| vertices[corners[k] as usize]);
            let edge = [a.min(b), a.max(b)];
            match open.remove(&edge) {
                Some((other, side)) => {
                    neighbours[triangle][k] = Some(other);
                    neighbours[other as usize][side] = Some(triangle as u32);
                }
                None => {
                    open.insert(edge, (triangle as u32, k));
                }
            }
        }
    }
    neighbours
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, Vec3, Vec4};

    use super::*;

    /// Two squares side by side, with these u at x = 0, 1 and 2 on a map of 10 × 10 texels.
    fn strip(u: [f32; 3]) -> ObjectChart {
        let vertex = |x: usize, y: f32| Vertex {
            position: Vec3::new(x as f32, y, 0.0),
            normal: Vec3::Z,
            direction: Vec3::Z,
            tangent: Vec4::X,
            uv: Vec2::new(u[x], y),
            repeat_length: 1.0,
        };
        let vertices = (0..3).flat_map(|x| [vertex(x, 0.0), vertex(x, 1.0)]).collect();
        let triangles = vec![[0, 2, 1], [2, 3, 1], [2, 4, 3], [4, 5, 3]];
        let mesh = SurfaceMesh { vertices, triangles, ..SurfaceMesh::default() };
        let neighbours = neighbours(&mesh);
        ObjectChart { mesh, neighbours, texels: DVec2::splat(10.0), goes_on: true }
    }

    #[test]
    fn a_uv_is_followed_to_the_triangle_that_shows_it() {
        // Twice the density on the right.
        let chart = strip([0.0, 1.0, 3.0]);
        let x = |u: f64| chart.foot(0, DVec2::new(u, 0.3)).point.x;
        for (u, expected) in [(0.2, 0.2), (0.9, 0.9), (1.5, 1.25), (2.8, 1.9), (3.5, 2.25), (-0.5, -0.5)] {
            assert!((x(u) - expected).abs() < 1e-6, "{u}: {}", x(u));
        }
        let (left, right) = (chart.foot(0, DVec2::new(0.5, 0.5)), chart.foot(0, DVec2::new(2.0, 0.5)));
        // A whole unit: ten texels of the left, twenty of the right.
        assert!((left.texels_to(&right) - 10.0).abs() < 1e-5 && (right.texels_to(&left) - 20.0).abs() < 1e-5);
    }

    #[test]
    fn a_mirrored_neighbour_is_not_entered() {
        let chart = strip([0.0, 1.0, 0.0]);
        let foot = chart.foot(0, DVec2::new(1.2, 0.5));
        assert!((foot.point.x - 1.2).abs() < 1e-6, "{foot:?}");
        // Found from the other side it lies on the other side.
        assert!((chart.foot(3, DVec2::new(1.2, 0.5)).point.x - 0.8).abs() < 1e-6);
    }

    #[test]
    fn a_triangle_without_area_in_uv_ends_the_way() {
        let chart = strip([1.0, 1.0, 1.0]);
        let foot = chart.foot(0, DVec2::new(7.0, 0.5));
        assert!(foot.point.is_finite());
        assert_eq!(foot.texels_to(&foot), 0.0);
    }
}
