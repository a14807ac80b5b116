//! Reliefs that a picture does not show because it sees them from behind.

use glam::Vec3;

use crate::{Camera, Material, Object, Scene, SurfaceTechnique};

impl Scene {
    /// Returns a note for every material whose relief is in the picture, but seen from behind alone, where nothing of it is
    /// drawn.
    #[must_use]
    pub fn notes_on_unseen_reliefs(&self) -> Vec<String> {
        let frustum = Frustum::new(&self.camera, self.image.width as f32 / self.image.height.max(1) as f32);
        let unseen = |number: usize, material: &Material| {
            let mut own = self.objects.iter().filter(|object| object.material == number);
            is_one_sided(material) && own.any(|object| frustum.sees_only_the_back_of(object))
        };
        let materials = self.materials.iter().enumerate().filter(|&(number, material)| unseen(number, material));
        materials
            .map(|(_, Material { name, .. })| {
                format!(
                    "the relief of material \"{name}\" is seen from behind, where nothing of it is drawn; two_sided = true in \
                     [materials.{name}] draws both sides"
                )
            })
            .collect()
    }
}

fn is_one_sided(material: &Material) -> bool {
    let technique = material.relief.technique;
    let is_relief = technique.marched().is_some() || technique == SurfaceTechnique::Displacement;
    is_relief && material.maps.height.is_some() && !material.is_two_sided()
}

/// The space that the camera sees.
struct Frustum {
    eye: Vec3,
    near: f32,
    forward: Vec3,
    /// Unit vectors divided by half the picture's width and height at distance 1.
    right: Vec3,
    up: Vec3,
}

impl Frustum {
    fn new(camera: &Camera, aspect: f32) -> Self {
        let forward = (camera.target - camera.position).normalize_or_zero();
        let right = forward.cross(camera.up).normalize_or_zero();
        let half = (camera.vertical_fov.to_radians() * 0.5).tan();
        let (eye, near) = (camera.position, camera.near);
        Self { eye, near, forward, right: right / (half * aspect), up: right.cross(forward) / half }
    }

    /// True if the object is in the picture and all its triangles face away from the eye.
    fn sees_only_the_back_of(&self, object: &Object) -> bool {
        let mesh = &object.mesh;
        let from_eye = |index: u32| object.transform.transform_point3(mesh.positions[index as usize]) - self.eye;
        let side = object.transform.matrix3.determinant().signum();
        let faces_away = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(from_eye);
            (b - a).cross(c - a).dot(a) * side > 0.0
        };
        mesh.triangles.iter().all(faces_away) && self.may_see(&mesh.triangles.iter().flatten().map(|&i| from_eye(i)))
    }

    /// False if all points, relative to the eye, lie beyond the same side of the picture.
    fn may_see(&self, points: &(impl Iterator<Item = Vec3> + Clone)) -> bool {
        let beyond: [&dyn Fn(Vec3) -> f32; 5] = [
            &|p| self.near - p.dot(self.forward),
            &|p| p.dot(self.right) - p.dot(self.forward),
            &|p| -p.dot(self.right) - p.dot(self.forward),
            &|p| p.dot(self.up) - p.dot(self.forward),
            &|p| -p.dot(self.up) - p.dot(self.forward),
        ];
        !beyond.iter().any(|side| points.clone().all(|point| side(point) > 0.0))
    }
}
