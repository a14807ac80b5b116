use glam::{Mat2, Vec2, Vec3, Vec4};
use relievo_scene::{HeightRange, Object, Scene};

use crate::RenderError;
use crate::bvh::{Bounds, Tree};
use crate::material::Look;
use crate::tessellate::{displaced, subdivided_count};

/// More than this would take over 4 GB of memory.
const MAX_TRIANGLES: u64 = 16_000_000;

/// A corner of a triangle in scene space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vertex {
    pub(crate) position: Vec3,
    pub(crate) normal: Vec3,
    /// xyz along +u, w the handedness: bitangent (picture up) = w · (normal × tangent).
    pub(crate) tangent: Vec4,
    /// In texture repeats.
    pub(crate) uv: Vec2,
    /// dP/du and dP/dv of one texture repeat as columns, in the (tangent, bitangent) frame, scene units.
    pub(crate) jacobian: Mat2,
}

/// Triangles in scene space.
#[derive(Clone, Debug, Default)]
pub(crate) struct Patchwork {
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// An object as the renderer sees it.
pub(crate) struct Thing {
    pub(crate) look: usize,
    /// Upper corner of the texture range: the lower one is (0, 0).
    pub(crate) repeat: Vec2,
    /// Scene units, measured along the scene-space normal, per object unit: for `depth`.
    pub(crate) depth_scale: DepthScale,
}

/// How far one object unit along the object-space normal moves a surface along its scene-space normal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DepthScale {
    /// Object to scene, transposed: maps scene normals to object space up to length.
    transposed: glam::Mat3,
}

impl DepthScale {
    /// For a surface with this unit normal in scene space.
    pub(crate) fn along(&self, normal: Vec3) -> f32 {
        // Planes move by 1/|M⁻ᵀ n| for a unit object normal n; with the scene normal N = M⁻ᵀn/|M⁻ᵀn| that is |MᵀN|.
        (self.transposed * normal).length()
    }
}

/// Everything that can be hit.
pub(crate) struct World {
    pub(crate) looks: Vec<Look>,
    pub(crate) things: Vec<Thing>,
    pub(crate) patchwork: Patchwork,
    /// Which thing each triangle belongs to.
    pub(crate) owner: Vec<u32>,
    /// All triangles that are the surface, or have it below them: nothing of them lies before the polygon.
    pub(crate) tree: Tree,
    /// The triangles whose relief rises above them: the surface may be far from where a ray meets the polygon, so that no
    /// distance rules one out.
    pub(crate) risen: Tree,
}

impl World {
    pub(crate) fn new(scene: &Scene) -> Result<Self, RenderError> {
        let looks: Vec<Look> =
            scene.materials.iter().map(|material| Look::new(material, scene.shading.color_space)).collect();
        let mut patchwork = Patchwork::default();
        let mut owner = Vec::new();
        let mut things = Vec::new();
        for (index, object) in scene.objects.iter().enumerate() {
            let look = &looks[object.material];
            let thing = Thing {
                look: object.material,
                repeat: object.uv_repeat,
                depth_scale: DepthScale { transposed: glam::Mat3::from(object.transform.matrix3).transpose() },
            };
            let mut part = placed(object);
            let grid = if look.is_displaced() { look.relief.grid } else { 1 };
            let triangles = owner.len() as u64 + subdivided_count(&part, grid, object.uv_repeat);
            if triangles > MAX_TRIANGLES {
                return Err(RenderError::TooManyTriangles { object: index, triangles, grid, max: MAX_TRIANGLES });
            }
            if look.is_displaced() {
                part = displaced(&part, &thing, look, object.uv_repeat);
            }
            let offset = patchwork.vertices.len() as u32;
            owner.resize(owner.len() + part.triangles.len(), things.len() as u32);
            patchwork.triangles.extend(part.triangles.iter().map(|t| t.map(|i| i + offset)));
            patchwork.vertices.append(&mut part.vertices);
            things.push(thing);
        }
        let tree_of = |risen: bool| {
            let chosen = |triangle: &u32| looks[things[owner[*triangle as usize] as usize].look].is_risen() == risen;
            let triangles: Vec<u32> = (0..owner.len() as u32).filter(chosen).collect();
            let corners = |&t: &u32| patchwork.triangles[t as usize].map(|i| patchwork.vertices[i as usize].position);
            let bounds: Vec<Bounds> = triangles.iter().map(|t| Bounds::around(corners(t))).collect();
            Tree::build(&bounds, &triangles)
        };
        let (tree, risen) = (tree_of(false), tree_of(true));
        Ok(Self { looks, things, patchwork, owner, tree, risen })
    }

    /// Index of the material of a triangle.
    pub(crate) fn material_of(&self, triangle: u32) -> u32 {
        self.things[self.owner[triangle as usize] as usize].look as u32
    }

    pub(crate) fn corners(&self, triangle: u32) -> [&Vertex; 3] {
        self.patchwork.triangles[triangle as usize].map(|i| &self.patchwork.vertices[i as usize])
    }

    pub(crate) fn thing_of(&self, triangle: u32) -> (&Thing, &Look) {
        let thing = &self.things[self.owner[triangle as usize] as usize];
        (thing, &self.looks[thing.look])
    }
}

/// The distance between height 0 and height 1 at a vertex, in scene units.
pub(crate) fn full_depth(look: &Look, thing: &Thing, vertex: &Vertex) -> f32 {
    match look.range {
        HeightRange::Scale(scale) => scale * vertex.jacobian.x_axis.length(),
        HeightRange::Depth(depth) => depth * thing.depth_scale.along(vertex.normal.normalize_or_zero()),
    }
}

/// The object's mesh in scene space, with the lengths of its uv axes.
fn placed(object: &Object) -> Patchwork {
    let mesh = &object.mesh;
    let matrix = glam::Mat3::from(object.transform.matrix3);
    let normals = matrix.inverse().transpose();
    // A mirroring transform turns the triangles and the tangent frames inside out.
    let mirrored = matrix.determinant() < 0.0;
    let handedness = if mirrored { -1.0 } else { 1.0 };
    let mut vertices: Vec<Vertex> = (0..mesh.positions.len())
        .map(|i| Vertex {
            position: object.transform.transform_point3(mesh.positions[i]),
            normal: (normals * mesh.normals[i]).normalize_or_zero(),
            tangent: (matrix * mesh.tangents[i].truncate()).normalize_or_zero().extend(mesh.tangents[i].w * handedness),
            uv: mesh.uvs[i] * object.uv_repeat,
            jacobian: Mat2::ZERO,
        })
        .collect();
    let triangles: Vec<[u32; 3]> =
        mesh.triangles.iter().map(|&[a, b, c]| if mirrored { [a, c, b] } else { [a, b, c] }).collect();
    measure_uv_axes(&mut vertices, &triangles);
    Patchwork { vertices, triangles }
}

/// Gives every vertex the mean of dP/du and dP/dv over its triangles, weighted by area, so that lengths vary smoothly over
/// a curved mesh.
fn measure_uv_axes(vertices: &mut [Vertex], triangles: &[[u32; 3]]) {
    let mut sums = vec![(Vec3::ZERO, Vec3::ZERO, 0.0f32); vertices.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|i| &vertices[i as usize]);
        let (e1, e2) = (b.position - a.position, c.position - a.position);
        let (d1, d2) = (b.uv - a.uv, c.uv - a.uv);
        let uv_area = d1.perp_dot(d2);
        let area = e1.cross(e2).length();
        let (du, dv) = ((e1 * d2.y - e2 * d1.y) / uv_area, (e2 * d1.x - e1 * d2.x) / uv_area);
        if !(du.is_finite() && dv.is_finite() && area > 0.0) {
            continue;
        }
        for &i in triangle {
            let (sum_u, sum_v, weight) = &mut sums[i as usize];
            *sum_u += du * area;
            *sum_v += dv * area;
            *weight += area;
        }
    }
    for (vertex, (du, dv, weight)) in vertices.iter_mut().zip(sums) {
        let normal = vertex.normal;
        let tangent = vertex.tangent.truncate();
        let bitangent = normal.cross(tangent) * vertex.tangent.w;
        let columns = [du, dv].map(|d| Vec2::new(d.dot(tangent), d.dot(bitangent)) / weight);
        let jacobian = Mat2::from_cols(columns[0], columns[1]);
        // Without usable texture coordinates there is no relief to scale: any invertible frame will do.
        vertex.jacobian = if jacobian.is_finite() && jacobian.determinant() != 0.0 {
            jacobian
        } else {
            Mat2::from_diagonal(Vec2::new(1.0, -1.0))
        };
    }
}
