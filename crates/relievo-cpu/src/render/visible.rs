//! The points that a picture shows, without the picture: for judging them.

use glam::Vec3;
use rayon::prelude::*;
use relievo_map::Grid;

use super::Renderer;
use crate::camera::CameraRays;
use crate::surface::ViewRay;
use crate::{Precision, RenderError};

/// The point of a surface that is seen through the centre of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VisiblePoint {
    /// Index into [`relievo_scene::Scene::objects`].
    pub object: u32,
    /// The triangle of the object's mesh on which it was found: that of the polygon the ray met, unless the technique crosses
    /// to others.
    pub triangle: u32,
    /// Displaced texture coordinates, in texture repeats.
    pub uv: [f32; 2],
    /// Its place as far as the technique knows it, scene units.
    pub position: Vec3,
}

/// The points that are wanted.
#[derive(Clone, Copy, Default)]
pub struct VisibleOptions<'a> {
    /// Threads to use; `None`: all cores.
    pub threads: Option<usize>,
    /// Arithmetic that finds hits.
    pub precision: Precision,
    /// Distance in texels by which displaced surfaces that are traced without being kept are moved along their normals; at
    /// most [`Renderer::MAX_RAISE`] either way.
    pub raise: f64,
    /// The pixels that are looked at, as large as the picture; `None`: all.
    pub only: Option<&'a Grid<bool>>,
}

/// A displaced surface that is traced without being kept: `grid = "texel"`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplacedSurface {
    /// Index into [`relievo_scene::Scene::objects`].
    pub object: usize,
    /// Index into [`relievo_scene::Scene::materials`].
    pub material: usize,
    /// Vertices along a texel of the height map, where they stand farthest apart.
    pub vertices_per_texel: f64,
    /// Micro-triangles of all its triangles.
    pub triangles: u64,
}

impl Renderer {
    /// Returns the point that the centre of every pixel shows; `None` where nothing is hit.
    ///
    /// # Errors
    /// If the threads asked for cannot be had.
    pub fn visible_points(&self, options: &VisibleOptions<'_>) -> Result<Grid<Option<VisiblePoint>>, RenderError> {
        super::on_threads(options.threads, || self.trace_visible_points(options))
    }

    /// Longest way, in texels, by which [`Renderer::visible_points`] raises or lowers a surface.
    pub const MAX_RAISE: f64 = crate::geometry::MAX_RAISE;

    fn trace_visible_points(&self, options: &VisibleOptions<'_>) -> Grid<Option<VisiblePoint>> {
        let (width, height) = (self.image.width, self.image.height);
        let camera_rays = CameraRays::new(&self.camera, self.bounds, width, height);
        let mut points = Grid::filled(width, height, None);
        points.texels_mut().par_chunks_mut(width as usize).enumerate().for_each(|(y, row)| {
            for (x, point) in row.iter_mut().enumerate() {
                if options.only.is_some_and(|only| !only.get(x as u32, y as u32)) {
                    continue;
                }
                let (px, py) = (x as f32 + 0.5, y as f32 + 0.5);
                let [origin, direction] = camera_rays.ray(px, py);
                let ray = ViewRay {
                    origin,
                    direction,
                    neighbours: &|| [camera_rays.ray(px + 1.0, py), camera_rays.ray(px, py + 1.0)],
                    near: camera_rays.near / direction.dot(camera_rays.forward),
                    raise: options.raise,
                };
                let (surface, _) = self.world.first_surface(&ray, options.precision);
                *point = surface.map(|surface| {
                    let [object, triangle] = self.world.place_in_scene(surface.triangle);
                    VisiblePoint { object, triangle, uv: surface.record.uv, position: surface.position }
                });
            }
        });
        points
    }

    /// Returns the displaced surfaces that are traced without being kept.
    #[must_use]
    pub fn displaced_surfaces(&self) -> Vec<DisplacedSurface> {
        let surfaces = self.world.micro_surfaces().map(|([object, material], micro, count)| DisplacedSurface {
            object,
            material,
            vertices_per_texel: micro.per_texel,
            triangles: count as u64 * u64::from(micro.cuts).pow(2),
        });
        surfaces.collect()
    }
}
