use std::sync::Arc;

use glam::{Affine3A, Vec2};
use relievo_map::ColorMap;

use crate::{Camera, Light, Material, Mesh};

/// A whole scene, ready to be drawn by any backend.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The picture's size and background.
    pub image: ImageSettings,
    /// The eye.
    pub camera: Camera,
    /// The lights.
    pub lights: Vec<Light>,
    /// How light becomes colour.
    pub shading: Shading,
    /// The materials.
    pub materials: Vec<Material>,
    /// The things in the scene.
    pub objects: Vec<Object>,
    /// The surroundings as an equirectangular picture, `environment` of `[shading]`: the top row is up.
    pub environment: Option<ColorMap>,
    /// What loading found worth saying: maps recognised and ignored, channels that differ, lost precision.
    pub notes: Vec<String>,
}

/// A thing in the scene: a mesh at a place, with a material.
#[derive(Clone, Debug)]
pub struct Object {
    /// The geometry, in object units.
    pub mesh: Arc<Mesh>,
    /// Index into [`Scene::materials`].
    pub material: usize,
    /// Object to scene; invertible.
    pub transform: Affine3A,
    /// How often the texture repeats over the mesh's uv range, along u and v; > 0.
    pub uv_repeat: Vec2,
}

/// The `[image]` table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageSettings {
    /// Pixels, at least 1.
    pub width: u32,
    /// Pixels, at least 1.
    pub height: u32,
    /// Where nothing is hit: display RGB, 0..1.
    pub background: [f32; 3],
    /// Samples per pixel, at least 1.
    pub samples: u32,
}

impl ImageSettings {
    /// The most pixels a picture may have on a side.
    pub const MAX_SIDE: u32 = 1 << 14;
    /// The most pixels a picture may have in all: half of that squared.
    pub const MAX_PIXELS: u64 = 1 << 27;
    /// The most samples per pixel.
    pub const MAX_SAMPLES: u32 = 4096;
}

impl Default for ImageSettings {
    fn default() -> Self {
        Self { width: 800, height: 600, background: [0.1; 3], samples: 1 }
    }
}

/// The `[shading]` table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shading {
    /// The reflection model.
    pub model: ShadingModel,
    /// Whether colours are decoded to light and encoded again.
    pub color_space: ColorSpace,
    /// Factor on the base colour that is there without any light; ambient occlusion darkens it.
    pub ambient: f32,
    /// Blinn-Phong: strength of the highlight.
    pub specular: f32,
    /// Blinn-Phong: exponent of the highlight.
    pub shininess: f32,
}

impl Default for Shading {
    fn default() -> Self {
        Self {
            model: ShadingModel::BlinnPhong,
            color_space: ColorSpace::Linear,
            ambient: 0.1,
            specular: 0.2,
            shininess: 32.0,
        }
    }
}

/// The reflection model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShadingModel {
    /// `ambient·c + max(L·n, 0)·c + specular·max(n·H, 0)^shininess` (Blinn 1977), as in the tutorials.
    BlinnPhong,
    /// Metallic-roughness: GGX distribution, Smith visibility, Schlick Fresnel, as glTF 2.0 defines it.
    Pbr,
}

/// Whether colours are decoded to light and encoded again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColorSpace {
    /// sRGB maps are decoded, shading is linear, the picture is encoded again.
    Linear,
    /// Numbers are taken as they are, in and out: the tutorials' way. Heights of 8-bit files are filtered in 8 bits, as
    /// the software OpenGL did that drew the tutorials' pictures.
    Display,
}
