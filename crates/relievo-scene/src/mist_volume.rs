//! The space that mist on a flat mesh fills, and the rays through it, as all backends march them.

use glam::{DVec2, DVec3, Vec2, Vec3, Vec4};
use relievo_march::MediumRay;

use crate::{Camera, CameraKind, Material, MistError, Object, ReliefDepth, Scene, SurfaceMesh};

/// Distance of the eye that parallel rays come from, scene units.
const FAR_EYE: f32 = 1e6;

/// The space between the lid and the floor of a relief over the outline of its flat mesh, in scene space.
///
/// Texture coordinates and height are affine in it. An outline that is not convex counts as its hull.
#[derive(Clone, Debug, PartialEq)]
pub struct MistVolume {
    /// Index into [`Scene::objects`].
    pub object: usize,
    /// Index into [`Scene::materials`].
    pub material: usize,
    /// A point of the mesh, scene units.
    pub origin: Vec3,
    /// Texture coordinates there, in texture repeats.
    pub uv: Vec2,
    /// Height there.
    pub height: f32,
    /// Gradients of u, v and height, per scene unit.
    pub gradients: [Vec3; 3],
    /// Planes around the space: inside, xyz · p ≥ w. First the floor and the lid, then the walls.
    pub planes: Vec<Vec4>,
}

/// The part of a ray that lies in a [`MistVolume`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MistSpan {
    /// Distance along the ray at which it begins, scene units.
    pub start: f32,
    /// Length, scene units.
    pub length: f32,
    /// The same part in the relief, from distance 0 on.
    pub ray: MediumRay,
}

impl MistVolume {
    /// Most corners of the outline.
    pub const MAX_CORNERS: usize = 16;

    /// Most planes: the outline's, floor and lid.
    pub const MAX_PLANES: usize = Self::MAX_CORNERS + 2;

    /// Measures the space of an object's mist; `None` if it is empty: without depth.
    ///
    /// # Errors
    /// If the mesh is not flat with one affine texture, or its outline has too many corners.
    pub fn new(scene: &Scene, object: usize) -> Result<Option<Self>, MistError> {
        let material = scene.objects[object].material;
        Self::of(&scene.objects[object], &scene.materials[material], [object, material])
    }

    pub(crate) fn of(
        object: &Object,
        material: &Material,
        [number, material_number]: [usize; 2],
    ) -> Result<Option<Self>, MistError> {
        let mesh = SurfaceMesh::in_scene_space(object, material);
        let (Some(face), Some(&[first, ..])) = (mesh.faces.first(), mesh.triangles.first()) else { return Ok(None) };
        if mesh.charts.len() != 1 || !mesh.charts[0].is_flat {
            return Err(MistError::NotFlat);
        }
        let vertex = mesh.vertices[first as usize];
        let depth = f64::from(ReliefDepth::new(material.height, object).at(&vertex));
        let normal = vertex.direction.as_dvec3().normalize_or_zero();
        let (du, dv) = (face.dp_du.as_dvec3(), face.dp_dv.as_dvec3());
        let (across_u, across_v) = (dv.cross(normal), normal.cross(du));
        let gradients = [across_u / du.dot(across_u), across_v / dv.dot(across_v), normal / depth];
        if !gradients.iter().all(|gradient| gradient.as_vec3().is_finite()) {
            return Ok(None);
        }
        let origin = vertex.position.as_dvec3();
        let plane = |inward: DVec3, point: DVec3| inward.as_vec3().extend(inward.dot(point) as f32);
        let midlevel = f64::from(material.midlevel);
        let mut planes = vec![
            plane(normal, origin - normal * (midlevel * depth)),
            plane(-normal, origin + normal * ((1.0 - midlevel) * depth)),
        ];
        let corners = outline(&mesh, origin, normal);
        if corners.len() > Self::MAX_CORNERS {
            return Err(MistError::Outline { corners: corners.len() });
        }
        let next = corners.iter().cycle().skip(1);
        planes.extend(corners.iter().zip(next).map(|(&a, &b)| plane(normal.cross(b - a).normalize_or_zero(), a)));
        Ok(Some(Self {
            object: number,
            material: material_number,
            origin: vertex.position,
            uv: vertex.uv,
            height: material.midlevel,
            gradients: gradients.map(DVec3::as_vec3),
            planes,
        }))
    }

    /// Returns the part of a ray between two distances that lies inside; `direction` is of unit length.
    #[must_use]
    pub fn span(&self, origin: Vec3, direction: Vec3, [near, far]: [f32; 2]) -> Option<MistSpan> {
        let (mut start, mut end) = (near, far);
        for plane in &self.planes {
            let inward = plane.truncate();
            let (beyond, rate) = (inward.dot(origin) - plane.w, inward.dot(direction));
            let t = -beyond / rate;
            if rate > 0.0 {
                start = start.max(t);
            } else if rate < 0.0 {
                end = end.min(t);
            } else if beyond < 0.0 {
                return None;
            }
        }
        // Also leaves out what is not a number.
        if !(start < end && end < f32::INFINITY) {
            return None;
        }
        let offset = origin + direction * start - self.origin;
        let [u, v, height] = self.gradients;
        let ray = MediumRay {
            uv: [self.uv.x + u.dot(offset), self.uv.y + v.dot(offset)],
            uv_delta: [u.dot(direction), v.dot(direction)],
            height: self.height + height.dot(offset),
            height_delta: height.dot(direction),
        };
        Some(MistSpan { start, length: end - start, ray })
    }

    /// Returns true if all of another volume lies behind this one as seen from `eye`: a plane of either parts them.
    fn hides(&self, other: &Self, eye: Vec3) -> bool {
        let side = |plane: &Vec4, point: Vec3| plane.truncate().dot(point) - plane.w;
        let beyond = |plane: &Vec4, volume: &Self| volume.corners().iter().all(|&corner| side(plane, corner) <= 1e-4);
        // Seen from within its side of the plane, what lies on the other side is behind.
        self.planes.iter().any(|plane| side(plane, eye) >= 0.0 && beyond(plane, other))
            || other.planes.iter().any(|plane| side(plane, eye) <= 0.0 && beyond(plane, self))
    }

    /// Returns the corners of the floor and the lid.
    fn corners(&self) -> Vec<Vec3> {
        let walls = &self.planes[2..];
        let meet = |a: &Vec4, b: &Vec4, c: &Vec4| {
            let [na, nb, nc] = [a, b, c].map(|plane| plane.truncate());
            (nb.cross(nc) * a.w + nc.cross(na) * b.w + na.cross(nb) * c.w) / na.dot(nb.cross(nc))
        };
        let pairs = walls.iter().zip(walls.iter().cycle().skip(1));
        pairs.flat_map(|(a, b)| self.planes[..2].iter().map(move |end| meet(end, a, b))).collect()
    }
}

impl Scene {
    /// Returns the spaces that the scene's mist fills, in the order of the objects.
    ///
    /// # Errors
    /// The first mesh that mist cannot lie on, with the object it belongs to.
    pub fn mist_volumes(&self) -> Result<Vec<MistVolume>, (usize, MistError)> {
        let objects = self.objects.iter().enumerate();
        let mists = objects.filter(|(_, object)| self.materials[object.material].is_mist());
        let volumes = mists.map(|(number, _)| MistVolume::new(self, number).map_err(|error| (number, error)));
        volumes.filter_map(Result::transpose).collect()
    }
}

/// Returns the order in which volumes are drawn over each other, the last one in front: for volumes that a plane of one of them
/// parts. Those that reach into each other stay in their order.
#[must_use]
pub fn mist_order(volumes: &[MistVolume], camera: &Camera) -> Vec<usize> {
    let eye = match camera.kind {
        CameraKind::Perspective => camera.position,
        CameraKind::Orthographic => camera.position - (camera.target - camera.position).normalize_or_zero() * FAR_EYE,
    };
    let mut left: Vec<usize> = (0..volumes.len()).collect();
    let mut order = Vec::with_capacity(left.len());
    while !left.is_empty() {
        let hides = |i: usize, j: usize| volumes[i].hides(&volumes[j], eye) && !volumes[j].hides(&volumes[i], eye);
        // In a circle none is last.
        let last = left.iter().position(|&i| !left.iter().any(|&j| j != i && hides(i, j))).unwrap_or(0);
        order.push(left.remove(last));
    }
    order
}

/// Returns the corners of the convex hull of a flat mesh, counter-clockwise seen against the normal (Andrew 1979).
fn outline(mesh: &SurfaceMesh, origin: DVec3, normal: DVec3) -> Vec<DVec3> {
    let along = normal.any_orthonormal_vector();
    let across = normal.cross(along);
    let mut points: Vec<DVec2> = mesh
        .vertices
        .iter()
        .map(|vertex| vertex.position.as_dvec3() - origin)
        .map(|offset| DVec2::new(offset.dot(along), offset.dot(across)))
        .collect();
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let extent = points.iter().map(|point| point.abs().max_element()).fold(0.0, f64::max);
    let straight = 1e-6 * extent * extent;
    let half = |points: &mut dyn Iterator<Item = &DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for &point in points {
            while let [.., a, b] = chain[..]
                && (b - a).perp_dot(point - a) <= straight
            {
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut hull = half(&mut points.iter());
    hull.extend(half(&mut points.iter().rev()));
    hull.into_iter().map(|point| origin + along * point.x + across * point.y).collect()
}
