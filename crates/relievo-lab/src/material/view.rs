use std::path::Path;
use std::sync::Arc;

use glam::{Affine3A, Vec2, Vec3};
use relievo_scene::{Filter, HeightRange, LoadOptions, Mesh, Scene};

use super::test_material::TestMaterial;
use crate::compare::{CompareOptions, Comparison, compare};
use crate::error::LabError;
use crate::technique::TechniqueSpec;

const PLANE_SCENE: &str = include_str!("plane.toml");

/// Azimuth of the camera from the plane's v axis, in degrees: oblique to rows of stones.
const AZIMUTH: f32 = 25.0;

/// A plane of a material, seen under one angle.
#[derive(Clone, Copy)]
pub(crate) struct MaterialView<'a> {
    pub(crate) material: &'a TestMaterial,
    /// The full depth in texels.
    pub(crate) depth: f32,
    /// Texels per pixel across the view.
    pub(crate) minification: u32,
    /// Degrees from the normal.
    pub(crate) angle: f32,
    /// Size of the picture in pixels.
    pub(crate) size: [u32; 2],
}

impl MaterialView<'_> {
    /// Compares techniques with displaced geometry.
    pub(crate) fn compare(&self, techniques: Vec<TechniqueSpec>, samples: u32) -> Result<Comparison, LabError> {
        let mut scene = self.scene(samples)?;
        for material in &mut scene.materials {
            // Displaced triangles would be given other mip levels than the polygon: textures are not judged here.
            material.filter = Filter::Linear;
        }
        let options = CompareOptions { techniques, ..CompareOptions::default() };
        Ok(compare(&scene, &options)?)
    }

    /// The scene of the plane, just large enough to fill the picture.
    pub(crate) fn scene(&self, samples: u32) -> Result<Scene, LabError> {
        let mut scene = Scene::parse(PLANE_SCENE, "the lab's scene", Path::new(""), &LoadOptions::default())?;
        let [width, height] = self.size;
        (scene.image.width, scene.image.height, scene.image.samples) = (width, height, samples);
        let [columns, rows] = self.material.size().map(|n| n as f32);
        // One unit of the scene is one texel.
        let per_pixel = self.minification as f32;
        let half_view = (0.5 * scene.camera.vertical_fov).to_radians();
        let distance = 0.5 * height as f32 * per_pixel / half_view.tan();
        let (tilt, azimuth) = (self.angle.to_radians(), AZIMUTH.to_radians());
        let ground = Vec3::new(azimuth.sin(), -azimuth.cos(), 0.0);
        scene.camera.position = (ground * tilt.sin() + Vec3::Z * tilt.cos()) * distance;
        scene.camera.target = Vec3::ZERO;
        // The far border is seen under the widest angle; the relief is entered before it is met.
        let widest = (tilt + half_view).min(89.5f32.to_radians());
        let far = distance * (tilt.cos() * widest.tan() - tilt.sin()) + self.depth * widest.tan();
        let aside = 0.5 * width as f32 * per_pixel * (1.0 + far / distance);
        let half = (far * azimuth.cos() + aside * azimuth.sin()).max(far * azimuth.sin() + aside * azimuth.cos());
        // A whole number of texels, shifted by half of one: the vertices of displaced geometry stand on texel centres.
        let half = (1.05 * half).ceil();
        for object in &mut scene.objects {
            object.transform = Affine3A::from_scale(Vec3::new(half, half, 1.0));
            object.uv_repeat = Vec2::new(2.0 * half / columns, 2.0 * half / rows);
            let mut mesh = Mesh::clone(&object.mesh);
            mesh.uvs.iter_mut().for_each(|uv| *uv += 0.25 / half);
            object.mesh = Arc::new(mesh);
        }
        for material in &mut scene.materials {
            material.height = HeightRange::Scale(self.depth / columns);
            if self.material.maps.base_color.is_some() {
                material.base_color = [1.0; 3];
            }
            material.maps = self.material.maps.clone();
            material.maps.height = Some(self.material.height.clone());
        }
        Ok(scene)
    }
}
