mod mist;
mod visible;

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use glam::Vec3;
use rayon::prelude::*;
use relievo_map::GridId;
use relievo_march::Shadow;
use relievo_scene::{Camera, EnvironmentMap, Frame, ImageSettings, Light, Scene, Shading, mist_order, sample_offset};

use crate::camera::CameraRays;
use crate::display::Display;
use crate::frame::{Pixel, par_rows};
use crate::geometry::{World, WorldKey};
use crate::shading::environment;
use crate::shading::light::{incoming, light_points, pixel_rotation};
use crate::shading::mean_normal::MeanNormal;
use crate::shading::reflection::reflected;
use crate::surface::{MarchCost, OccluderSet, SurfacePoint, ViewRay};
use crate::{Precision, RenderError, RenderOptions};

pub use visible::{DisplacedSurface, VisibleOptions, VisiblePoint};

/// A scene made ready for drawing: maps with their mip levels, triangles in a bounding volume hierarchy.
pub struct Renderer {
    image: ImageSettings,
    camera: Camera,
    /// The scene's corners.
    bounds: [Vec3; 2],
    lights: Vec<Light>,
    shading: Shading,
    world: Arc<World>,
    made_of: WorldKey,
    /// The spaces of mist in the world, from the farthest to the nearest.
    mist_order: Vec<usize>,
    environment: Option<Arc<EnvironmentMap>>,
    environment_id: Option<GridId>,
    display: Display,
    /// Colour where nothing is hit and there is no environment.
    background: Vec3,
}

/// The result of tracing one camera ray.
struct TracedSample {
    color: Vec3,
    depth: f32,
    normal: Vec3,
    uv: [f32; 2],
    material: Option<u32>,
    cost: MarchCost,
    shadow: f32,
    hit: bool,
}

impl Renderer {
    /// Makes a scene ready for drawing: builds mip levels and the hierarchy.
    ///
    /// # Errors
    /// If a displaced grid is too fine, or the scene breaks a promise (loaded scenes never do).
    pub fn new(scene: &Scene) -> Result<Self, RenderError> {
        Self::after(scene, None)
    }

    /// Makes another scene ready, as [`Renderer::new`] does, and shares with this renderer what is the same in both: maps, and
    /// triangles where no object and no material has changed. For the frames of an animation.
    ///
    /// # Errors
    /// As [`Renderer::new`].
    pub fn for_scene(&self, scene: &Scene) -> Result<Self, RenderError> {
        Self::after(scene, Some(self))
    }

    fn after(scene: &Scene, known: Option<&Self>) -> Result<Self, RenderError> {
        scene.validate()?;
        let scene =
            scene.with_heights_made(|_| false).map_err(|error| RenderError::UnmadeHeights(error.to_string()))?;
        let scene = scene.as_ref();
        let made_of = WorldKey::of(scene);
        let world = match known.filter(|known| known.made_of == made_of) {
            Some(known) => Arc::clone(&known.world),
            None => Arc::new(World::new(scene, known.map_or(&[], |known| &known.world.materials))?),
        };
        let space = scene.shading.color_space;
        let environment_id = scene.environment.as_ref().map(|map| map.grid.id());
        let same = known.filter(|known| (known.environment_id, known.shading.color_space) == (environment_id, space));
        let environment = same.map_or_else(
            || scene.environment.as_ref().map(|map| Arc::new(EnvironmentMap::new(map, space))),
            |known| known.environment.clone(),
        );
        let display = Display::new(scene.shading.color_space);
        Ok(Self {
            image: scene.image,
            camera: scene.camera,
            bounds: scene.bounds(),
            lights: scene.lights.clone(),
            shading: scene.shading,
            background: display.decode(scene.image.background),
            display,
            mist_order: mist_order(&world.mists, &scene.camera),
            world,
            made_of,
            environment,
            environment_id,
        })
    }

    /// Returns the number of triangles, displaced grids included, but not [`Renderer::displaced_surfaces`].
    #[must_use]
    pub fn triangles(&self) -> usize {
        self.world.triangles
    }

    /// Draws the scene.
    ///
    /// # Errors
    /// If the threads asked for cannot be had.
    pub fn render(&self, options: &RenderOptions<'_>) -> Result<Frame, RenderError> {
        on_threads(options.threads, || self.draw(options))
    }

    fn draw(&self, options: &RenderOptions<'_>) -> Frame {
        let (width, height) = (self.image.width, self.image.height);
        let camera_rays = CameraRays::new(&self.camera, self.bounds, width, height);
        let done = AtomicU32::new(0);
        let mut frame = Frame::blank(width, height);
        par_rows(&mut frame).for_each(|(y, mut row)| {
            for x in 0..width {
                row.set(x as usize, &self.pixel(&camera_rays, x, y, options.precision));
            }
            if let Some(progress) = options.progress {
                progress(done.fetch_add(1, Ordering::Relaxed) + 1, height);
            }
        });
        frame
    }

    fn pixel(&self, camera_rays: &CameraRays, x: u32, y: u32, precision: Precision) -> Pixel {
        let samples = self.image.samples;
        // A pixel's samples share it: each needs the detail of its part only.
        let spacing = 1.0 / (samples as f32).sqrt();
        let mut color = Vec3::ZERO;
        let (mut fetches, mut iterations, mut shadow, mut hits) = (0.0, 0.0, 0.0, 0.0);
        let mut centre = None;
        for i in 0..samples {
            let [dx, dy] = sample_offset(i).map(|x| x as f32);
            let (px, py) = (x as f32 + dx, y as f32 + dy);
            let [origin, direction] = camera_rays.ray(px, py);
            let ray = ViewRay {
                origin,
                direction,
                neighbours: &|| [camera_rays.ray(px + spacing, py), camera_rays.ray(px, py + spacing)],
                near: camera_rays.near / direction.dot(camera_rays.forward),
                raise: 0.0,
            };
            let rotation = pixel_rotation(x, y) + i as f32;
            let sample = self.trace(&ray, camera_rays, rotation, precision);
            color += sample.color;
            fetches += sample.cost.fetches as f32;
            iterations += sample.cost.iterations as f32;
            shadow += sample.shadow;
            hits += f32::from(u8::from(sample.hit));
            centre.get_or_insert(sample);
        }
        let n = samples.max(1) as f32;
        let centre = centre.unwrap_or_else(|| self.background(Vec3::Z));
        Pixel {
            display: self.display.encode(color / n),
            depth: centre.depth,
            normal: centre.normal.into(),
            uv: centre.uv,
            material: centre.material,
            fetches: fetches / n,
            iterations: iterations / n,
            shadow: shadow / n,
            hit: hits / n,
        }
    }

    fn trace(&self, ray: &ViewRay<'_>, camera_rays: &CameraRays, rotation: f32, precision: Precision) -> TracedSample {
        let (surface, cost) = self.world.first_surface(ray, precision);
        let Some(surface) = surface else {
            let background = self.background(ray.direction);
            let color = self.through_mist(background.color, ray, f32::INFINITY, rotation);
            return TracedSample { color, cost, ..background };
        };
        let normal = surface.patch.shading_normal(&surface.record, &surface.footprint);
        // Thin surfaces are lit on the side that is seen.
        let direction = if surface.from_behind { -normal.direction } else { normal.direction };
        let normal = MeanNormal { direction, ..normal };
        let (color, shadow) = self.shade(&surface, normal, -ray.direction, rotation);
        let color = self.through_mist(color, ray, surface.t, rotation);
        TracedSample {
            color,
            depth: surface.t * ray.direction.dot(camera_rays.forward) + camera_rays.skipped,
            normal: direction,
            uv: surface.record.uv,
            material: Some(self.world.material_of(surface.triangle)),
            cost,
            shadow,
            hit: true,
        }
    }

    /// Returns the colour towards `view`, and the mean shadow factor over the lights.
    fn shade(&self, surface: &SurfacePoint<'_>, normal: MeanNormal, view: Vec3, rotation: f32) -> (Vec3, f32) {
        let shading = &self.shading;
        let sample =
            surface.patch.material_sample(surface.record.uv, &surface.footprint, shading.model).widened(normal);
        let mut color = Vec3::from(sample.base_color) * (shading.ambient * sample.ao);
        if let Some(environment) = &self.environment {
            color += environment::reflected(environment, shading.model, &sample, normal.direction, view);
        }
        let mut unshadowed = 0.0;
        for light in &self.lights {
            let Some(arriving) = incoming(light, surface.position, shading.model) else {
                unshadowed += 1.0;
                continue;
            };
            let kind = surface.patch.material.relief.shadow;
            let factor = if kind == Shadow::None {
                1.0
            } else {
                // The tutorials' shadows know no light's size.
                let light = if kind == Shadow::Exact { *light } else { Light { radius: 0.0, ..*light } };
                let points = light_points(&light, &arriving, rotation);
                let (sum, count) = points.fold((0.0, 0u32), |(sum, count), (direction, distance)| {
                    let nth = (light.radius > 0.0).then_some(count);
                    (sum + self.light_factor(surface, kind, direction, distance, nth), count + 1)
                });
                let through = if kind == Shadow::Exact { self.mist_factor(surface.position, &arriving) } else { 1.0 };
                through * sum / count as f32
            };
            unshadowed += factor;
            if factor > 0.0 {
                let reflected = reflected(shading, &sample, normal, view, arriving.direction);
                color += reflected * arriving.color * factor;
            }
        }
        (color, if self.lights.is_empty() { 1.0 } else { unshadowed / self.lights.len() as f32 })
    }

    /// Returns the fraction of the light in `direction` that passes the relief itself and, for exact shadows, everything
    /// else: the tutorials' two kinds know the relief alone.
    fn light_factor(
        &self,
        surface: &SurfacePoint<'_>,
        kind: Shadow,
        direction: Vec3,
        distance: f32,
        nth: Option<u32>,
    ) -> f32 {
        let patch = &surface.patch;
        let own = patch.self_shadow(&surface.record, &surface.footprint, direction, distance, nth);
        let occluders = match kind {
            Shadow::Exact => Some(OccluderSet::Everything),
            _ if patch.material.is_displaced() => Some(OccluderSet::Itself),
            _ => None,
        };
        let hidden = |occluders| self.world.is_hidden(surface, occluders, direction, distance);
        if own == 0.0 || occluders.is_some_and(hidden) { 0.0 } else { own }
    }

    fn background(&self, direction: Vec3) -> TracedSample {
        let color = match &self.environment {
            Some(environment) => environment.radiance(direction),
            None => self.background,
        };
        TracedSample {
            color,
            depth: f32::INFINITY,
            normal: Vec3::ZERO,
            uv: [0.0; 2],
            material: None,
            cost: MarchCost::default(),
            shadow: 1.0,
            hit: false,
        }
    }
}

/// Calls `work` on this number of threads, or on all cores.
fn on_threads<T: Send>(threads: Option<usize>, work: impl FnOnce() -> T + Send) -> Result<T, RenderError> {
    match threads {
        None => Ok(work()),
        Some(threads) => rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .map_err(|error| RenderError::Threads { threads, reason: error.to_string() })
            .map(|pool| pool.install(work)),
    }
}
