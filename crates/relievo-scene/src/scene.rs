use std::borrow::Cow;
use std::sync::Arc;

use glam::{Affine3A, Vec2, Vec3};
use relievo_make::MakeError;
use relievo_map::ColorMap;

use crate::{Camera, Light, Material, Mesh, Shading};

/// A scene, ready to be drawn by any backend.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Size, background and samples of the picture.
    pub image: ImageSettings,
    /// The camera.
    pub camera: Camera,
    /// The lights.
    pub lights: Vec<Light>,
    /// Reflection model and colour space.
    pub shading: Shading,
    /// The materials.
    pub materials: Vec<Material>,
    /// The objects.
    pub objects: Vec<Object>,
    /// Environment map, an equirectangular picture whose top row is up: `environment` of `[shading]`.
    pub environment: Option<ColorMap>,
    /// Notes of loading: maps recognised and ignored, channels that differ, lost precision.
    pub notes: Vec<String>,
}

impl Scene {
    /// Returns the least and the largest corner of all meshes, without their reliefs, scene units.
    #[must_use]
    pub fn bounds(&self) -> [Vec3; 2] {
        let points = self.objects.iter().flat_map(|object| {
            object.mesh.positions.iter().map(|&position| object.transform.transform_point3(position))
        });
        points.map(|point| [point; 2]).reduce(|[low, high], [a, b]| [low.min(a), high.max(b)]).unwrap_or_default()
    }
}

impl Scene {
    /// Returns the scene with the heights of its moment: those that change and are not made yet, see
    /// [`Material::heights_are_made`], are made, but for the materials that the caller makes by itself.
    ///
    /// # Errors
    /// If heights cannot be made.
    pub fn with_heights_made(&self, by_caller: impl Fn(usize) -> bool) -> Result<Cow<'_, Self>, MakeError> {
        let mut scene = Cow::Borrowed(self);
        for (index, material) in self.materials.iter().enumerate() {
            let waits = !material.heights_are_made && !by_caller(index);
            if let Some(changing) = material.changing_heights.as_ref().filter(|_| waits) {
                let heights = changing.heights()?;
                let material = &mut scene.to_mut().materials[index];
                material.maps.height = Some(heights);
                material.heights_are_made = true;
            }
        }
        Ok(scene)
    }
}

/// An object: a mesh with a transform and a material.
#[derive(Clone, Debug)]
pub struct Object {
    /// Geometry, in object units.
    pub mesh: Arc<Mesh>,
    /// Index into [`Scene::materials`].
    pub material: usize,
    /// Transform from object to scene space; invertible.
    pub transform: Affine3A,
    /// Texture repeats over the mesh's uv range, along u and v; > 0.
    pub uv_repeat: Vec2,
}

/// The `[image]` table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageSettings {
    /// Width in pixels, at least 1.
    pub width: u32,
    /// Height in pixels, at least 1.
    pub height: u32,
    /// Colour where nothing is hit: display RGB, 0..1.
    pub background: [f32; 3],
    /// Samples per pixel, at least 1.
    pub samples: u32,
}

impl ImageSettings {
    /// Most pixels on a side of the picture.
    pub const MAX_SIDE: u32 = 1 << 14;
    /// Most pixels of the picture in all: half of that squared.
    pub const MAX_PIXELS: u64 = 1 << 27;
    /// Most samples per pixel.
    pub const MAX_SAMPLES: u32 = 4096;
}

impl Default for ImageSettings {
    fn default() -> Self {
        Self { width: 800, height: 600, background: [0.1; 3], samples: 1 }
    }
}
