//! Reliefs that a picture does not show because it sees them from behind.

use std::collections::BTreeSet;

use glam::Vec3;

use crate::{Camera, ImageSettings, Material, Scene, SurfaceTechnique};

/// Most rays along a side of the picture that are looked along.
const MOST_RAYS: u32 = 32;

/// Most triangles that are tried in all: a small part of the time that drawing takes.
const MOST_TRIALS: usize = 20_000_000;

impl Scene {
    /// Returns a note for every material whose relief the camera sees from behind, where nothing of it is drawn: as far as a
    /// few rays through the picture tell.
    #[must_use]
    pub fn notes_on_unseen_reliefs(&self) -> Vec<String> {
        let unseen: BTreeSet<usize> =
            self.first_polygons().into_iter().flatten().filter_map(|first| first.unseen).collect();
        let names = unseen.into_iter().map(|number| &self.materials[number].name);
        names
            .map(|name| {
                format!(
                    "the relief of material \"{name}\" is seen from behind, where nothing of it is drawn; two_sided = true in \
                     [materials.{name}] draws both sides"
                )
            })
            .collect()
    }

    /// Returns the first polygon along each of a few rays.
    fn first_polygons(&self) -> Vec<Option<FirstPolygon>> {
        if !self.materials.iter().any(is_one_sided) {
            return Vec::new();
        }
        let triangles: usize = self.objects.iter().map(|object| object.mesh.triangles.len()).sum();
        let side = (MOST_TRIALS / triangles.max(1)).isqrt().clamp(4, MOST_RAYS as usize) as u32;
        let rays = rays(&self.camera, &self.image, side);
        let mut first: Vec<Option<FirstPolygon>> = vec![None; rays.len()];
        for object in &self.objects {
            let Some(material) = self.materials.get(object.material) else { continue };
            if material.is_mist() {
                continue;
            }
            let one_sided = is_one_sided(material);
            let outside = object.transform.matrix3.determinant().signum();
            for triangle in &object.mesh.triangles {
                let corners = triangle.map(|i| object.transform.transform_point3(object.mesh.positions[i as usize]));
                let [a, b, c] = corners;
                let normal = (b - a).cross(c - a) * outside;
                for (ray, first) in rays.iter().zip(&mut first) {
                    let Some(t) = ray.hit(corners).filter(|&t| first.is_none_or(|first| t < first.t)) else { continue };
                    let from_behind = normal.dot(ray.direction) > 0.0;
                    *first = Some(FirstPolygon { t, unseen: (one_sided && from_behind).then_some(object.material) });
                }
            }
        }
        first
    }
}

fn is_one_sided(material: &Material) -> bool {
    let technique = material.relief.technique;
    let is_relief = technique.marched().is_some() || technique == SurfaceTechnique::Displacement;
    is_relief && material.maps.height.is_some() && !material.is_two_sided() && !material.is_mist()
}

/// The first polygon along a ray.
#[derive(Clone, Copy)]
struct FirstPolygon {
    /// Distance in units of the ray's direction.
    t: f32,
    /// Material of a relief that is not drawn from here.
    unseen: Option<usize>,
}

/// A ray through the picture.
struct Ray {
    origin: Vec3,
    /// As long as its part along the camera's axis is 1.
    direction: Vec3,
    near: f32,
}

impl Ray {
    /// Returns the distance to a triangle, from either side (Möller and Trumbore 1997).
    fn hit(&self, [a, b, c]: [Vec3; 3]) -> Option<f32> {
        let (e1, e2, from) = (b - a, c - a, self.origin - a);
        let (p, q) = (self.direction.cross(e2), from.cross(e1));
        let inverse = 1.0 / e1.dot(p);
        let (u, v, t) = (from.dot(p) * inverse, self.direction.dot(q) * inverse, e2.dot(q) * inverse);
        // Written so that NaN is no hit.
        (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= self.near && t < f32::INFINITY).then_some(t)
    }
}

/// Returns rays through the middles of `side`² parts of the picture.
fn rays(camera: &Camera, image: &ImageSettings, side: u32) -> Vec<Ray> {
    let [right, up, forward] = camera.axes();
    let half = camera.half_height();
    let aspect = image.width as f32 / image.height.max(1) as f32;
    let offset = |k: u32| (2.0 * (k as f32 + 0.5) / side as f32 - 1.0) * half;
    let (position, near) = (camera.position, camera.near);
    (0..side * side)
        .map(|k| {
            let aside = right * (offset(k % side) * aspect) + up * offset(k / side);
            if camera.is_orthographic() {
                Ray { origin: position + aside, direction: forward, near }
            } else {
                Ray { origin: position, direction: forward + aside, near }
            }
        })
        .collect()
}
