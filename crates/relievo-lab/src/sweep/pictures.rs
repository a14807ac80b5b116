//! Pictures of a material against its supersampled truth.

use std::path::Path;
use std::sync::Arc;

use glam::{Affine3A, Vec2, Vec3};
use relievo_cpu::{Precision, RenderOptions, Renderer};
use relievo_map::{Grid, write_picture};
use relievo_march::Technique;
use relievo_scene::{Filter, HeightRange, LoadOptions, Mesh, Scene, SurfaceTechnique};

use super::figures::PictureRow;
use super::options::PictureOptions;
use crate::{
    CompareOptions, Comparison, Contender, DEFAULT_PIXELS_PER_DEGREE, LabError, TestMaterial, compare, flip, heat,
    pixel_difference,
};

const SCENE: &str = include_str!("scene.toml");

/// Which way the plane is seen from, beside its v axis, in degrees: rows of stones are to be crossed.
const AZIMUTH: f32 = 25.0;

/// Samples per pixel of the truth at a distance: more than these make no difference that FLIP would see.
const MAX_TRUTH_SAMPLES: u32 = 64;

/// A truth of more texels per side has one vertex per texel instead of two: more would be 4 million triangles.
const TWO_PER_TEXEL: u32 = 720;

/// A hit error that is drawn white, in texels.
const WHITE_TEXELS: f32 = 8.0;

/// One picture of a sweep, for all candidates.
pub(crate) struct View<'a> {
    pub(crate) material: &'a TestMaterial,
    /// The full depth in texels.
    pub(crate) depth: f32,
    /// Texels per pixel across the view.
    pub(crate) minification: u32,
    /// Degrees from the normal.
    pub(crate) angle: f32,
    pub(crate) options: &'a PictureOptions,
}

impl View<'_> {
    /// Draws the truth and every candidate, judges them, and keeps the pictures in `folder` (which is there) under `name`.
    pub(crate) fn judge(&self, folder: &Path, name: &str) -> Result<Vec<PictureRow>, LabError> {
        if self.minification == 1 { self.near(folder, name) } else { self.far(folder, name) }
    }

    /// Against really displaced geometry, with the same samples per pixel: pictures differ by the march alone.
    fn near(&self, folder: &Path, name: &str) -> Result<Vec<PictureRow>, LabError> {
        let contenders = self.options.candidates.iter().map(crate::Candidate::contender).collect();
        let comparison = self.compare(contenders)?;
        let truth = format!("{name}truth.png");
        write_picture(&folder.join(&truth), &comparison.truth)?;
        let mut rows = Vec::new();
        for (candidate, entry) in self.options.candidates.iter().zip(&comparison.entries) {
            let file = format!("{name}{}.png", file_name(&candidate.to_string()));
            write_picture(&folder.join(&file), &entry.picture)?;
            let hits = format!("{name}{}-hits.png", file_name(&candidate.to_string()));
            write_picture(&folder.join(&hits), &heat(&entry.hit_error_map, WHITE_TEXELS))?;
            rows.push(PictureRow {
                technique: candidate.to_string(),
                flip: entry.flip.mean,
                psnr_db: entry.psnr.is_finite().then_some(entry.psnr),
                picture: file,
                hits: Some(hits),
                truth: truth.clone(),
                truth_is: "displaced geometry".to_owned(),
                samples: self.options.samples,
                truth_samples: self.options.samples,
                ..self.row()
            });
        }
        Ok(rows)
    }

    /// Contenders beside displaced geometry.
    pub(crate) fn compare(&self, contenders: Vec<Contender>) -> Result<Comparison, LabError> {
        let mut scene = self.scene(self.options.samples)?;
        for material in &mut scene.materials {
            // Displaced triangles would be given other mip levels than the polygon: textures are not what is judged.
            material.filter = Filter::Linear;
        }
        let texels = (2.0 * self.half_extent(&scene)) as u32;
        let per_texel = if texels <= TWO_PER_TEXEL { 2 } else { 1 };
        let options = CompareOptions { contenders, grid: Some(texels * per_texel + 1), ..CompareOptions::default() };
        Ok(compare(&scene, &options)?)
    }

    /// From afar, one sample per pixel as in a game, with and without `lod`, against the oracle's hits with many samples:
    /// a grid fine enough for displacement would have more triangles than memory holds.
    fn far(&self, folder: &Path, name: &str) -> Result<Vec<PictureRow>, LabError> {
        let truth_samples = (4 * self.minification * self.minification).min(MAX_TRUTH_SAMPLES);
        let mut scene = self.scene(truth_samples)?;
        for material in &mut scene.materials {
            // Many samples need no filter, and a filter would blur them.
            material.filter = Filter::Linear;
            Contender::of(SurfaceTechnique::Marched(Technique::Exact)).apply(&mut material.relief);
            material.relief.write_depth = Some(true);
        }
        let truth_picture = draw(&scene, Precision::Oracle)?;
        let truth = format!("{name}truth.png");
        write_picture(&folder.join(&truth), &truth_picture)?;
        let mut rows = Vec::new();
        for candidate in &self.options.candidates {
            for lod in [false, true] {
                let mut scene = self.scene(1)?;
                for material in &mut scene.materials {
                    candidate.contender().apply(&mut material.relief);
                    (material.relief.write_depth, material.relief.lod) = (Some(true), lod);
                }
                let picture = draw(&scene, Precision::Single)?;
                let suffix = if lod { "-lod" } else { "" };
                let file = format!("{name}{}{suffix}.png", file_name(&candidate.to_string()));
                write_picture(&folder.join(&file), &picture)?;
                let psnr = pixel_difference(&truth_picture, &picture, 0).map_or(0.0, |difference| difference.psnr);
                rows.push(PictureRow {
                    technique: candidate.to_string(),
                    lod,
                    flip: flip(&truth_picture, &picture, DEFAULT_PIXELS_PER_DEGREE)?.mean,
                    psnr_db: psnr.is_finite().then_some(psnr),
                    picture: file,
                    hits: None,
                    truth: truth.clone(),
                    truth_is: "the oracle's hits".to_owned(),
                    samples: 1,
                    truth_samples,
                    ..self.row()
                });
            }
        }
        Ok(rows)
    }

    fn row(&self) -> PictureRow {
        PictureRow {
            material: self.material.name.clone(),
            depth_texels: self.depth,
            minification: self.minification,
            angle: self.angle,
            ..PictureRow::default()
        }
    }

    /// Half the side of the plane in texels.
    fn half_extent(&self, scene: &Scene) -> f32 {
        scene.objects.iter().map(|object| object.transform.matrix3.x_axis.x).fold(0.0, f32::max)
    }

    /// The plane, just large enough to fill the picture.
    fn scene(&self, samples: u32) -> Result<Scene, LabError> {
        let mut scene = Scene::parse(SCENE, "the lab's scene", Path::new(""), &LoadOptions::default())?;
        let [width, height] = self.options.size;
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

fn draw(scene: &Scene, precision: Precision) -> Result<Grid<[u8; 3]>, LabError> {
    Ok(Renderer::new(scene)?.render(&RenderOptions { precision, ..RenderOptions::default() })?.pixels)
}

/// A name fit for files everywhere.
pub(crate) fn file_name(text: &str) -> String {
    text.chars().map(|c| if c.is_alphanumeric() || "-_+".contains(c) { c } else { '-' }).collect()
}
