//! Scenes made by code, and what is measured in pictures.

use std::sync::Arc;

use glam::{Affine3A, Mat3, Quat, Vec2, Vec3};
use relievo_cpu::{Frame, RenderError, RenderOptions, Renderer};
use relievo_map::{ColorEncoding, ColorMap, Grid, HeightMap, MapSet};
use relievo_march::{Shadow, Technique};
use relievo_scene::{
    Camera, HeightRange, ImageSettings, Light, LightKind, Material, Mesh, Object, Relief, Scene, Shading,
    SurfaceTechnique,
};

pub(crate) const EXACT: SurfaceTechnique = SurfaceTechnique::Marched(Technique::Exact);
pub(crate) const FLAT: SurfaceTechnique = SurfaceTechnique::Marched(Technique::None);

/// An empty stage of this size, seen from `eye` towards the origin, without lights.
pub(crate) fn stage(width: u32, height: u32, eye: Vec3) -> Scene {
    Scene {
        image: ImageSettings { width, height, ..ImageSettings::default() },
        camera: Camera { position: eye, ..Camera::default() },
        lights: Vec::new(),
        shading: Shading::default(),
        materials: Vec::new(),
        objects: Vec::new(),
        environment: None,
        notes: Vec::new(),
    }
}

/// Adds an object with a material of its own.
pub(crate) fn add(scene: &mut Scene, mesh: impl Into<Arc<Mesh>>, material: Material, transform: Affine3A) {
    let material_index = scene.materials.len();
    scene.materials.push(material);
    scene.objects.push(Object { mesh: mesh.into(), material: material_index, transform, uv_repeat: Vec2::ONE });
}

pub(crate) fn shape(name: &str) -> Mesh {
    Mesh::shape(name).unwrap()
}

pub(crate) fn moved(x: f32, y: f32, z: f32) -> Affine3A {
    Affine3A::from_translation(Vec3::new(x, y, z))
}

pub(crate) fn transform(scale: Vec3, degrees: Vec3, position: Vec3) -> Affine3A {
    let [x, y, z] = degrees.to_array().map(f32::to_radians);
    let rotation = Quat::from_rotation_z(z) * Quat::from_rotation_y(y) * Quat::from_rotation_x(x);
    Affine3A::from_mat3_translation(Mat3::from_quat(rotation) * Mat3::from_diagonal(scale), position)
}

pub(crate) fn point_light(x: f32, y: f32, z: f32) -> Light {
    Light { kind: LightKind::Point { position: Vec3::new(x, y, z) }, color: [1.0; 3], intensity: 1.0, radius: 0.0 }
}

pub(crate) fn sun(x: f32, y: f32, z: f32) -> Light {
    let direction = Vec3::new(x, y, z).normalize();
    Light { kind: LightKind::Directional { direction }, color: [1.0; 3], intensity: 1.0, radius: 0.0 }
}

/// A plain colour without relief, which receives shadows.
pub(crate) fn plain(color: [f32; 3]) -> Material {
    Material {
        base_color: color,
        relief: Relief { technique: FLAT, shadow: Shadow::Exact, ..Relief::default() },
        ..Material::default()
    }
}

/// A relief drawn by `exact` with exact shadows, in a colour that varies over the texture.
pub(crate) fn relief(height: HeightMap, scale: f32) -> Material {
    let (w, h) = (height.grid().width(), height.grid().height());
    let color = Grid::from_fn(w, h, |x, y| {
        let (u, v) = ((x as f32 + 0.5) / w as f32, (y as f32 + 0.5) / h as f32);
        let wave = |t: f32, n: f32| 0.55 + 0.35 * (t * n * std::f32::consts::TAU).sin();
        [wave(u, 4.0), wave(v, 3.0), wave(u + v, 2.0), 1.0]
    });
    let base_color = Some(ColorMap { grid: color, encoding: ColorEncoding::Linear });
    Material {
        maps: MapSet { height: Some(height), base_color, ..MapSet::default() },
        height: HeightRange::Scale(scale),
        relief: Relief { shadow: Shadow::Exact, ..Relief::default() },
        ..Material::default()
    }
}

/// Smooth hills that tile.
pub(crate) fn hills(width: u32, height: u32) -> HeightMap {
    relievo_make::shapes::sampled(width, height, |u, v| {
        let wave = |x: f64| (std::f64::consts::TAU * x).sin();
        0.5 + 0.3 * wave(2.0 * u + 0.1) * wave(2.0 * v + 0.3) + 0.2 * wave(3.0 * u - v)
    })
}

/// Flat stones with sloping sides, two to a repeat along u and four along v, in running bond.
pub(crate) fn stones(width: u32, height: u32) -> HeightMap {
    relievo_make::shapes::sampled(width, height, |u, v| {
        let row = (v * 4.0).floor();
        let (x, y) = ((u * 2.0 + 0.5 * (row % 2.0)).fract(), (v * 4.0).fract());
        let rim = ((0.5 - (x - 0.5).abs()) * 2.0).min(0.5 - (y - 0.5).abs());
        ((rim - 0.06) / 0.12).clamp(0.0, 1.0)
    })
}

pub(crate) fn with_technique(scene: &Scene, technique: SurfaceTechnique) -> Scene {
    let mut scene = scene.clone();
    for material in &mut scene.materials {
        material.relief.technique = technique;
    }
    scene
}

/// The same scene with its reliefs as real geometry.
pub(crate) fn displaced(scene: &Scene, grid: u32) -> Scene {
    let mut scene = scene.clone();
    for material in scene.materials.iter_mut().filter(|material| material.maps.height.is_some()) {
        material.relief.technique = SurfaceTechnique::Displacement;
        material.relief.grid = grid;
    }
    scene
}

pub(crate) fn with_shadow(scene: &Scene, shadow: Shadow) -> Scene {
    let mut scene = scene.clone();
    for material in &mut scene.materials {
        material.relief.shadow = shadow;
    }
    scene
}

pub(crate) fn draw(scene: &Scene) -> Frame {
    try_draw(scene).unwrap()
}

pub(crate) fn try_draw(scene: &Scene) -> Result<Frame, RenderError> {
    Renderer::new(scene)?.render(&RenderOptions::default())
}

/// Mean absolute difference over all channels, in 1/255.
pub(crate) fn mean_difference(a: &Frame, b: &Frame) -> f64 {
    let pairs = a.pixels.texels().iter().zip(b.pixels.texels());
    let sum: u64 = pairs.map(|(a, b)| (0..3).map(|k| u64::from(a[k].abs_diff(b[k]))).sum::<u64>()).sum();
    sum as f64 / (3 * a.pixels.texels().len()) as f64
}

/// The fraction of pixels off by more than `threshold` in any channel.
pub(crate) fn share_over(a: &Frame, b: &Frame, threshold: u8) -> f64 {
    let pairs = a.pixels.texels().iter().zip(b.pixels.texels());
    let over = pairs.filter(|(a, b)| (0..3).any(|k| a[k].abs_diff(b[k]) > threshold)).count();
    over as f64 / a.pixels.texels().len() as f64
}

/// A quantile of numbers, 0 ≤ q ≤ 1.
pub(crate) fn quantile(mut values: Vec<f64>, q: f64) -> f64 {
    assert!(!values.is_empty());
    values.sort_by(f64::total_cmp);
    values[((values.len() - 1) as f64 * q).round() as usize]
}

/// Brightness of a pixel: the sum of its channels.
pub(crate) fn brightness(frame: &Frame, x: u32, y: u32) -> f64 {
    frame.pixels.get(x, y).iter().map(|&c| f64::from(c)).sum()
}
