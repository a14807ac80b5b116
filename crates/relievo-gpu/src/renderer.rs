use std::num::NonZeroU64;

use glam::Vec2;
use relievo_map::srgb_to_linear;
use relievo_scene::{
    Aovs, Camera, ColorSpace, EnvironmentMap, Light, Material, Object, ReliefDepth, Scene, Shading, SurfaceTechnique,
};
use wgpu::util::DeviceExt;

use crate::GpuError;
use crate::error::guarded;
use crate::geometry::Geometry;
use crate::height_texture::check_size;
use crate::layout::{LightLayout, MAX_LIGHTS, ObjectLayout, ViewLayout};
use crate::material::{MaterialResources, MaterialUploader};
use crate::measure::Measured;
use crate::pipelines::{DEPTH_FORMAT, Pipelines, Targets};
use crate::render_permutation::{Casters, Output, Pass, background_source};
use crate::shadow_maps::{ShadowMaps, map_size};
use crate::shadow_views::ShadowViews;
use crate::supersample::{SAMPLE_FORMAT, Supersampler};
use crate::surroundings::SurroundingMaps;
use crate::view::{self, Sample};

/// Sums of more samples than this in half floats may be off by more than a step of eight bits.
const EXACT_SAMPLES: u32 = 64;

/// How to draw, beside what the scene says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RendererOptions {
    /// Samples along a stretched footprint, for materials with `filter = "trilinear"`: 1 (as the CPU draws) to 16.
    pub anisotropy: u16,
    /// Samples that the hardware takes of each pixel's polygons, 1 or 4 (multisampling). With 4 the borders of polygons are
    /// smooth, and those of clipped reliefs: where one ends inside a pixel it is marched once for each sample, and shaded
    /// once. The scene's own `samples` smooth everything, and cost as much as that many pictures.
    pub msaa: u32,
    /// Texels per side of a shadow map, 256 to 4096; `None`: as suits the picture. Less if all maps together would take
    /// more than 256 MiB.
    pub shadow_resolution: Option<u32>,
    /// Draw depth before colours, so that what is hidden is not shaded. Not with `msaa`.
    pub depth_prepass: bool,
}

impl Default for RendererOptions {
    fn default() -> Self {
        Self { anisotropy: 1, msaa: 1, shadow_resolution: None, depth_prepass: false }
    }
}

/// A scene made ready for drawing on a device that the caller owns, into textures that the caller owns.
///
/// Draws what `relievo-cpu` draws, up to the rounding of the device and to the texels of the shadow maps, in which objects
/// throw shadows on each other.
pub struct Renderer {
    device: wgpu::Device,
    queue: wgpu::Queue,
    options: RendererOptions,
    camera: Camera,
    shading: Shading,
    lights: Vec<Light>,
    background: wgpu::Color,
    output: Output,
    samples: u32,
    supersampler: Option<Supersampler>,
    pipelines: Pipelines,
    /// Draws the surroundings where there are any.
    sky: Option<wgpu::RenderPipeline>,
    looks: Vec<MaterialResources>,
    geometry: Geometry,
    /// The material of each object.
    materials: Vec<usize>,
    view_buffer: wgpu::Buffer,
    light_buffer: wgpu::Buffer,
    surroundings: SurroundingMaps,
    shadow_views: ShadowViews,
    shadow_maps: ShadowMaps,
    /// Whether the maps show the scene as it is.
    shadow_maps_drawn: bool,
    view_bindings: wgpu::BindGroup,
    object_bindings: wgpu::BindGroup,
    /// Distance of one sample's view, or one object, to the next in its buffer.
    stride: u32,
    depth: Option<([u32; 2], wgpu::TextureView)>,
    /// What the hardware takes several samples in.
    multisampled: Option<([u32; 2], wgpu::TextureView)>,
}

/// Where a picture goes.
#[derive(Clone, Copy, Debug)]
pub struct Target<'a> {
    /// In the format given to [`Renderer::new`], with usage RENDER_ATTACHMENT. All of it is drawn over.
    pub color: &'a wgpu::TextureView,
    /// For what else the caller draws: in [`Renderer::DEPTH_FORMAT`], with usage RENDER_ATTACHMENT, and with as many samples
    /// as [`RendererOptions::msaa`] says. 1 = on the camera's near plane, 0 = at infinity: near divided by the distance
    /// along the camera's axis. Without, the renderer has its own. With several samples per pixel by the scene it ends up
    /// with the last one's.
    pub depth: Option<&'a wgpu::TextureView>,
    /// Width and height of the views in pixels.
    pub size: [u32; 2],
    /// Where to note how long it took.
    pub timestamps: Option<Timestamps<'a>>,
}

impl<'a> Target<'a> {
    /// Colours alone, in a view of this size.
    #[must_use]
    pub fn new(color: &'a wgpu::TextureView, size: [u32; 2]) -> Self {
        Self { color, depth: None, size, timestamps: None }
    }
}

/// Timestamps around all that is drawn for a picture, shadow maps included where they had to be drawn anew. The device needs
/// the feature TIMESTAMP_QUERY.
#[derive(Clone, Copy, Debug)]
pub struct Timestamps<'a> {
    /// Of type Timestamp.
    pub set: &'a wgpu::QuerySet,
    /// Written before the first pass.
    pub begin: u32,
    /// Written after the last pass.
    pub end: u32,
}

/// One pass over all objects.
struct PassDescriptor<'a> {
    kind: Pass,
    colors: &'a [Option<wgpu::RenderPassColorAttachment<'a>>],
    depth: &'a wgpu::TextureView,
    /// Whether depth is what was drawn before.
    keeps_depth: bool,
    bindings: &'a wgpu::BindGroup,
    /// Of the view in its buffer.
    view: u32,
    timestamps: Option<wgpu::RenderPassTimestampWrites<'a>>,
}

impl Renderer {
    /// The format of depth textures.
    pub const DEPTH_FORMAT: wgpu::TextureFormat = DEPTH_FORMAT;

    /// Makes a scene ready: uploads its maps and meshes, and compiles its shaders.
    ///
    /// `format` is that of the textures it will be drawn into. Formats that encode sRGB by themselves get light, all others
    /// display numbers, 0..1.
    ///
    /// # Errors
    /// If a map or mesh is too large for the device, there are more lights than there is room for, the scene breaks a
    /// promise (which those that `relievo-scene` loads never do), or the device fails.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
        format: wgpu::TextureFormat,
        options: &RendererOptions,
    ) -> Result<Self, GpuError> {
        scene.validate()?;
        if !matches!(options.msaa, 1 | 4) {
            return Err(GpuError::Scene(format!("msaa is {}; every device can do 1 and 4 alone", options.msaa)));
        }
        guarded(device, || Self::build(device, queue, scene, format, options))
    }

    fn build(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
        format: wgpu::TextureFormat,
        options: &RendererOptions,
    ) -> Result<Self, GpuError> {
        let space = scene.shading.color_space;
        let output = match (space, format.is_srgb()) {
            (ColorSpace::Linear, true) | (ColorSpace::Display, false) => Output::AsIs,
            (ColorSpace::Linear, false) => Output::Encoded,
            (ColorSpace::Display, true) => Output::Decoded,
        };
        let samples = scene.image.samples;
        let supersampler = (samples > 1).then(|| Supersampler::new(device, samples, format, output)).transpose()?;
        let (format, output) = if samples > 1 { (SAMPLE_FORMAT, Output::Raw) } else { (format, output) };
        let after_depth = options.depth_prepass && options.msaa == 1;
        let pipelines = Pipelines::new(device, Targets { format, multisample: options.msaa, after_depth });
        let surroundings = scene.environment.as_ref().map(|map| EnvironmentMap::new(map, space));
        let sky = match surroundings {
            Some(_) => Some(pipelines.background(device, background_source(scene.shading.model, output)?)),
            None => None,
        };
        let geometry = Geometry::new(device, scene)?;
        let uniform = |label, contents: &[u8]| {
            let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage })
        };
        let alignment = device.limits().min_uniform_buffer_offset_alignment;
        let stride = alignment.max(size_of::<ObjectLayout>().max(size_of::<ViewLayout>()) as u32);
        let stride = stride.next_multiple_of(alignment.max(1));
        let view_buffer = uniform("relievo view", &vec![0; stride as usize * samples as usize]);
        let light_buffer = uniform("relievo lights", &[0; size_of::<LightLayout>() * MAX_LIGHTS]);
        let objects = uniform("relievo objects", &object_bytes(scene, stride as usize));
        let object_bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("relievo object"),
            layout: &pipelines.object,
            entries: &[part_of(0, &objects, size_of::<ObjectLayout>())],
        });
        let shadow_views = ShadowViews::default();
        let shadow_maps = ShadowMaps::new(device, &shadow_views, 1, stride);
        let surroundings = SurroundingMaps::new(device, queue, surroundings.as_ref())?;
        let view_bindings =
            view_bindings(device, &pipelines.view, &view_buffer, &light_buffer, &shadow_maps, &surroundings);
        let mut renderer = Self {
            device: device.clone(),
            queue: queue.clone(),
            options: *options,
            camera: scene.camera,
            shading: scene.shading,
            lights: scene.lights.clone(),
            background: background(scene, output),
            output,
            samples,
            supersampler,
            pipelines,
            sky,
            looks: Vec::new(),
            geometry,
            materials: scene.objects.iter().map(|object| object.material).collect(),
            view_buffer,
            light_buffer,
            surroundings,
            shadow_views,
            shadow_maps,
            shadow_maps_drawn: false,
            view_bindings,
            object_bindings,
            stride,
            depth: None,
            multisampled: None,
        };
        renderer.looks = renderer.make_looks(scene)?;
        renderer.place_lights()?;
        Ok(renderer)
    }

    /// What of the scene is drawn differently from the CPU, in words.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if self.samples > EXACT_SAMPLES {
            let samples = self.samples;
            notes.push(format!("{samples} samples per pixel are summed in half floats: colours may be some steps off"));
        }
        let left_out = self.shadow_views.left_out;
        if left_out > 0 {
            notes.push(format!("there is no room for the shadow maps of {left_out} lights: they shine through"));
        }
        notes
    }

    /// Triangles in the scene, displaced grids included.
    #[must_use]
    pub fn triangles(&self) -> usize {
        self.geometry.objects.iter().map(|indices| indices.len() / 3).sum()
    }

    /// Looks from elsewhere from now on.
    ///
    /// # Errors
    /// If the camera looks nowhere.
    pub fn set_camera(&mut self, camera: &Camera) -> Result<(), GpuError> {
        camera.validate()?;
        self.camera = *camera;
        Ok(())
    }

    /// Lights the scene differently from now on.
    ///
    /// # Errors
    /// If there are more lights than there is room for.
    pub fn set_lights(&mut self, lights: &[Light]) -> Result<(), GpuError> {
        view::lights(lights)?;
        self.lights = lights.to_vec();
        let device = self.device.clone();
        guarded(&device, || self.place_lights())
    }

    /// Takes over from a scene how deep its materials are and how their reliefs are drawn: `height_scale` or `depth`,
    /// `midlevel` and everything under `relief`. All else must be as in the scene the renderer was made from; maps are not
    /// uploaded again.
    ///
    /// # Errors
    /// If the scene has other materials or objects, or the device fails.
    pub fn set_reliefs(&mut self, scene: &Scene) -> Result<(), GpuError> {
        self.check_same(scene)?;
        let device = self.device.clone();
        guarded(&device, || {
            let moves = |material: &Material| {
                material.relief.technique == SurfaceTechnique::Displacement || material.midlevel < 1.0
            };
            // Everything is made before anything is changed.
            let moved = self.geometry.moved || scene.materials.iter().any(moves);
            let geometry = if moved { Some(Geometry::new(&self.device, scene)?) } else { None };
            self.looks = self.make_looks(scene)?;
            if let Some(geometry) = geometry {
                self.geometry = geometry;
            }
            self.place_lights()
        })
    }

    /// Marches a material's relief through these heights from now on, instead of through its own map: those of a
    /// [`crate::LiveHeights`] change as the caller has them change. `scene` is as for [`Renderer::set_reliefs`]. The
    /// material's other maps stay, so it should have no normal map: without one normals follow the heights. Displaced grids
    /// do not move.
    ///
    /// # Errors
    /// As [`Renderer::set_reliefs`], or if there is no such material.
    pub fn set_heights(
        &mut self,
        scene: &Scene,
        material: usize,
        heights: &crate::HeightTexture,
    ) -> Result<(), GpuError> {
        self.check_same(scene)?;
        let count = self.looks.len();
        let Some(look) = self.looks.get_mut(material) else {
            return Err(GpuError::Scene(format!("there is no material {material} among {count}")));
        };
        look.give(heights);
        let device = self.device.clone();
        guarded(&device, || {
            self.looks = self.make_looks(scene)?;
            self.place_lights()
        })
    }

    /// Tells that heights have changed on the device: what objects throw on each other is drawn anew with the next picture.
    pub fn heights_changed(&mut self) {
        self.shadow_maps_drawn = false;
    }

    /// Refuses a scene that is not a variant of the one the renderer was made from.
    fn check_same(&self, scene: &Scene) -> Result<(), GpuError> {
        scene.validate()?;
        let materials = scene.objects.iter().map(|object| object.material);
        if scene.materials.len() != self.looks.len() || !materials.eq(self.materials.iter().copied()) {
            let text = "it has other materials or objects than the one that the renderer was made from";
            return Err(GpuError::Scene(text.to_owned()));
        }
        Ok(())
    }

    /// Draws into all of `target`. Returns when the work is submitted, not when it is done.
    ///
    /// # Errors
    /// If a side of the size is 0 or over the device's limit, the views are not as [`Target`] says, or the device fails.
    pub fn draw(&mut self, target: &Target<'_>) -> Result<(), GpuError> {
        self.submitted(|this, encoder| this.record(encoder, target))
    }

    /// Draws the depth alone, with the march that [`Renderer::draw`] uses: what lies where, to the last bit. `depth` is
    /// as [`Target::depth`], but with one sample: the one in the pixels' middle.
    ///
    /// # Errors
    /// As [`Renderer::draw`].
    pub fn draw_depth(&mut self, depth: &wgpu::TextureView, size: [u32; 2]) -> Result<(), GpuError> {
        self.submitted(|this, encoder| this.record_depth(encoder, depth, size))
    }

    /// Measures instead of drawing: everything but colours, as `relievo-cpu` gives it, and what the marches cost. Of a pixel
    /// that several reliefs lie behind, the cost is that of the one that is seen. Blocks until it is done.
    ///
    /// # Errors
    /// If a side of the size is 0 or over the device's limit, the device cannot draw into float textures (which is so on
    /// some of WebGL2's class), or the device fails.
    pub fn measure(&mut self, size: [u32; 2]) -> Result<Aovs, GpuError> {
        let device = self.device.clone();
        let measured = guarded(&device, || {
            self.look(size)?;
            for kind in [Pass::MeasureSurface, Pass::MeasureLight] {
                self.make_pipelines(kind)?;
            }
            let mut measured = Measured::new(&self.device, size);
            let depth = self.single_depth(size);
            for sample in 0..self.samples {
                let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
                if sample == 0 {
                    self.draw_shadow_maps(&mut encoder, size, None)?;
                }
                for (kind, colors) in measured.passes() {
                    self.pass(
                        &mut encoder,
                        &PassDescriptor {
                            kind,
                            colors: &colors,
                            depth: &depth,
                            keeps_depth: false,
                            bindings: &self.view_bindings,
                            view: sample,
                            timestamps: None,
                        },
                    );
                }
                self.queue.submit([encoder.finish()]);
                measured.read(&self.device, &self.queue)?;
            }
            Ok(measured.aovs())
        });
        // Nothing that was submitted with what failed is sure to be there.
        self.shadow_maps_drawn &= measured.is_ok();
        measured
    }

    /// The shadow maps as they were drawn last, in the order of the lights: a layer for each, and six for a point light or a
    /// spot wider than 70° from its axis (its views along +x, −x, +y, −y, +z, −z, 90° wide); none for lights that no caster
    /// stands in, and at the end one that is empty where OpenGL needs it. In [`Renderer::DEPTH_FORMAT`], with usage COPY_SRC
    /// and TEXTURE_BINDING; of one texel if the scene needs none.
    #[must_use]
    pub fn shadow_maps(&self) -> &wgpu::Texture {
        &self.shadow_maps.texture
    }

    fn submitted(
        &mut self,
        record: impl FnOnce(&mut Self, &mut wgpu::CommandEncoder) -> Result<(), GpuError>,
    ) -> Result<(), GpuError> {
        let device = self.device.clone();
        let done = guarded(&device, || {
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            record(self, &mut encoder)?;
            self.queue.submit([encoder.finish()]);
            Ok(())
        });
        self.shadow_maps_drawn &= done.is_ok();
        done
    }

    /// [`Renderer::draw`] as part of the caller's own commands, which must be submitted before the next ones are recorded.
    /// Failures of the device come up where those are submitted.
    ///
    /// # Errors
    /// If a side of the size is 0 or over the device's limit.
    pub fn record(&mut self, encoder: &mut wgpu::CommandEncoder, target: &Target<'_>) -> Result<(), GpuError> {
        self.look(target.size)?;
        let begun = self.draw_shadow_maps(encoder, target.size, target.timestamps)?;
        let writes = |begins: bool, ends: bool| {
            let stamps = target.timestamps?;
            let begin = (begins && !begun).then_some(stamps.begin);
            let end = ends.then_some(stamps.end);
            (begin.is_some() || end.is_some()).then_some(wgpu::RenderPassTimestampWrites {
                query_set: stamps.set,
                beginning_of_pass_write_index: begin,
                end_of_pass_write_index: end,
            })
        };
        let depth = target.depth.cloned().unwrap_or_else(|| self.depth_view(target.size));
        let sampled = self.supersampler.as_mut().map(|sampler| sampler.target(&self.device, target.size));
        let color = sampled.as_ref().unwrap_or(target.color);
        let multisampled = (self.options.msaa > 1).then(|| self.multisampled_view(target.size));
        let prepass = self.options.depth_prepass && multisampled.is_none();
        for index in 0..self.samples {
            let attachment = wgpu::RenderPassColorAttachment {
                view: multisampled.as_ref().unwrap_or(color),
                depth_slice: None,
                resolve_target: multisampled.as_ref().map(|_| color),
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(self.background), store: wgpu::StoreOp::Store },
            };
            let to = PassDescriptor {
                kind: Pass::Depth,
                colors: &[],
                depth: &depth,
                keeps_depth: false,
                bindings: &self.view_bindings,
                view: index,
                timestamps: writes(index == 0, false),
            };
            if prepass {
                self.pass(encoder, &to);
            }
            let timestamps = writes(index == 0 && !prepass, sampled.is_none());
            let colors = [Some(attachment)];
            self.pass(
                encoder,
                &PassDescriptor { kind: Pass::Color, colors: &colors, keeps_depth: prepass, timestamps, ..to },
            );
            if let Some(supersampler) = &self.supersampler {
                supersampler.add(encoder, index == 0);
            }
        }
        if let Some(supersampler) = &self.supersampler {
            supersampler.resolve(encoder, target.color, writes(false, true));
        }
        Ok(())
    }

    /// [`Renderer::draw_depth`] as part of the caller's own commands; see [`Renderer::record`].
    ///
    /// # Errors
    /// If a side of the size is 0 or over the device's limit.
    pub fn record_depth(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        depth: &wgpu::TextureView,
        size: [u32; 2],
    ) -> Result<(), GpuError> {
        self.look(size)?;
        self.make_pipelines(Pass::Depth)?;
        self.pass(
            encoder,
            &PassDescriptor {
                kind: Pass::Depth,
                colors: &[],
                depth,
                keeps_depth: false,
                bindings: &self.view_bindings,
                view: 0,
                timestamps: None,
            },
        );
        Ok(())
    }

    /// Sets the camera up for all samples of a picture of this size.
    fn look(&self, size: [u32; 2]) -> Result<(), GpuError> {
        let [width, height] = size;
        if width == 0 || height == 0 {
            return Err(GpuError::Scene(format!("a picture of {width}×{height} pixels is not possible")));
        }
        check_size(&self.device, "the picture", width, height)?;
        for index in 0..self.samples {
            let sample = Sample { index, count: self.samples };
            let layout = view::view(&self.camera, &self.shading, self.lights.len(), size, sample);
            self.queue.write_buffer(&self.view_buffer, u64::from(index * self.stride), bytemuck::bytes_of(&layout));
        }
        Ok(())
    }

    /// Makes the materials ready, from the maps that are there already if they were before.
    fn make_looks(&mut self, scene: &Scene) -> Result<Vec<MaterialResources>, GpuError> {
        let mut looks = Vec::with_capacity(scene.materials.len());
        let layout = self.pipelines.surface.clone();
        let studio = MaterialUploader {
            device: &self.device,
            queue: &self.queue,
            layout: &layout,
            space: scene.shading.color_space,
            model: scene.shading.model,
            output: self.output,
            surroundings: self.sky.is_some(),
            anisotropy: self.options.anisotropy.clamp(1, 16),
            smooths_edges: self.options.msaa > 1,
        };
        for (number, material) in scene.materials.iter().enumerate() {
            let mut repeats = scene.objects.iter().filter(|o| o.material == number).map(|o| o.uv_repeat);
            let repeat = repeats.find(|&repeat| repeat != Vec2::ONE).unwrap_or(Vec2::ONE);
            let look = studio.look(number, material, repeat, self.looks.get(number))?;
            self.pipelines.make(&self.device, &look.permutation, Pass::Color)?;
            if self.options.depth_prepass {
                self.pipelines.make(&self.device, &look.permutation, Pass::Depth)?;
            }
            looks.push(look);
        }
        Ok(looks)
    }

    fn make_pipelines(&mut self, kind: Pass) -> Result<(), GpuError> {
        for look in &self.looks {
            self.pipelines.make(&self.device, &look.permutation, kind)?;
        }
        Ok(())
    }

    /// Uploads the lights, and plans their shadow maps if a material asks for them.
    fn place_lights(&mut self) -> Result<(), GpuError> {
        let wanted = self.looks.iter().any(|look| look.permutation.casters != Casters::Nothing);
        self.shadow_views =
            if wanted { ShadowViews::new(&self.lights, &self.geometry.casters) } else { ShadowViews::default() };
        self.shadow_maps_drawn = false;
        let mut layouts: [LightLayout; MAX_LIGHTS] = view::lights(&self.lights)?;
        self.shadow_views.tell(&mut layouts);
        self.queue.write_buffer(&self.light_buffer, 0, bytemuck::cast_slice(&layouts));
        if !self.shadow_views.layers.is_empty() {
            self.make_pipelines(Pass::Caster)?;
        }
        Ok(())
    }

    /// Draws what the lights see, unless that is known; tells whether it did.
    fn draw_shadow_maps(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        picture: [u32; 2],
        stamps: Option<Timestamps<'_>>,
    ) -> Result<bool, GpuError> {
        let count = self.shadow_views.layers.len();
        let largest = self.device.limits().max_texture_dimension_2d;
        let size = map_size(picture, count, self.options.shadow_resolution, largest);
        let fits = self.shadow_maps.layers.len() == count && (count == 0 || self.shadow_maps.size == size);
        if fits && self.shadow_maps_drawn {
            return Ok(false);
        }
        let (device, layout) = (&self.device, &self.pipelines.view);
        let (view, lights) = (&self.view_buffer, &self.light_buffer);
        if !fits {
            self.shadow_maps = ShadowMaps::new(device, &self.shadow_views, size, self.stride);
            self.view_bindings = view_bindings(device, layout, view, lights, &self.shadow_maps, &self.surroundings);
        }
        let maps = &self.shadow_maps;
        maps.aim(&self.queue, &self.shadow_views, self.stride);
        // A texture cannot be drawn into and looked up at once.
        let nothing = ShadowMaps::new(device, &ShadowViews::default(), 1, self.stride);
        let bindings = view_bindings(device, layout, &maps.views, lights, &nothing, &self.surroundings);
        for (number, [depth, objects]) in maps.layers.iter().enumerate() {
            let attachment = wgpu::RenderPassColorAttachment {
                view: objects,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            };
            let timestamps = stamps.filter(|_| number == 0).map(|stamps| wgpu::RenderPassTimestampWrites {
                query_set: stamps.set,
                beginning_of_pass_write_index: Some(stamps.begin),
                end_of_pass_write_index: None,
            });
            self.pass(
                encoder,
                &PassDescriptor {
                    kind: Pass::Caster,
                    colors: &[Some(attachment)],
                    depth,
                    keeps_depth: false,
                    bindings: &bindings,
                    view: number as u32,
                    timestamps,
                },
            );
        }
        self.shadow_maps_drawn = true;
        Ok(count > 0)
    }

    fn pass(&self, encoder: &mut wgpu::CommandEncoder, to: &PassDescriptor<'_>) {
        let load = if to.keeps_depth { wgpu::LoadOp::Load } else { wgpu::LoadOp::Clear(0.0) };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("relievo"),
            color_attachments: to.colors,
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: to.depth,
                depth_ops: Some(wgpu::Operations { load, store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            timestamp_writes: to.timestamps.clone(),
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_bind_group(0, to.bindings, &[to.view * self.stride]);
        if let (Some(sky), Pass::Color) = (&self.sky, to.kind) {
            pass.set_pipeline(sky);
            pass.draw(0..3, 0..1);
        }
        pass.set_vertex_buffer(0, self.geometry.vertices.slice(..));
        pass.set_index_buffer(self.geometry.indices.slice(..), wgpu::IndexFormat::Uint32);
        for (number, (indices, &material)) in self.geometry.objects.iter().zip(&self.materials).enumerate() {
            let Some(look) = self.looks.get(material) else { continue };
            let Some(pipeline) = self.pipelines.get(&look.permutation, to.kind) else { continue };
            pass.set_pipeline(pipeline);
            pass.set_bind_group(1, &look.bindings, &[]);
            pass.set_bind_group(2, &self.object_bindings, &[number as u32 * self.stride]);
            pass.draw_indexed(indices.clone(), 0, 0..1);
        }
    }

    /// The depth buffer of a picture of this size.
    fn depth_view(&mut self, size: [u32; 2]) -> wgpu::TextureView {
        if let Some((known, view)) = &self.depth
            && *known == size
        {
            return view.clone();
        }
        let view = attachment(&self.device, size, Renderer::DEPTH_FORMAT, self.options.msaa);
        self.depth = Some((size, view.clone()));
        view
    }

    /// One with a single sample.
    fn single_depth(&mut self, size: [u32; 2]) -> wgpu::TextureView {
        match self.options.msaa {
            1 => self.depth_view(size),
            _ => attachment(&self.device, size, Renderer::DEPTH_FORMAT, 1),
        }
    }

    /// What is drawn into before it is resolved.
    fn multisampled_view(&mut self, size: [u32; 2]) -> wgpu::TextureView {
        if let Some((known, view)) = &self.multisampled
            && *known == size
        {
            return view.clone();
        }
        let view = attachment(&self.device, size, self.pipelines.targets.format, self.options.msaa);
        self.multisampled = Some((size, view.clone()));
        view
    }
}

fn attachment(
    device: &wgpu::Device,
    [width, height]: [u32; 2],
    format: wgpu::TextureFormat,
    sample_count: u32,
) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("relievo attachment"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// One structure of a buffer of many.
fn part_of(binding: u32, buffer: &wgpu::Buffer, size: usize) -> wgpu::BindGroupEntry<'_> {
    let size = NonZeroU64::new(size as u64);
    wgpu::BindGroupEntry {
        binding,
        resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset: 0, size }),
    }
}

/// Group 0 of the shaders.
fn view_bindings(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    views: &wgpu::Buffer,
    lights: &wgpu::Buffer,
    shadows: &ShadowMaps,
    surroundings: &SurroundingMaps,
) -> wgpu::BindGroup {
    let texture = |binding, view| wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::TextureView(view) };
    let sampler = wgpu::BindingResource::Sampler(&surroundings.sampler);
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("relievo view"),
        layout,
        entries: &[
            part_of(0, views, size_of::<ViewLayout>()),
            wgpu::BindGroupEntry { binding: 1, resource: lights.as_entire_binding() },
            texture(2, &shadows.depths),
            texture(3, &shadows.objects),
            texture(4, &surroundings.picture),
            texture(5, &surroundings.blurred),
            wgpu::BindGroupEntry { binding: 6, resource: sampler },
            wgpu::BindGroupEntry { binding: 7, resource: surroundings.harmonics.as_entire_binding() },
        ],
    })
}

/// The settings of all objects, each at a multiple of `stride`; at least one, so that there is something to bind.
fn object_bytes(scene: &Scene, stride: usize) -> Vec<u8> {
    let mut bytes = vec![0; stride * scene.objects.len().max(1)];
    for (number, (object, place)) in scene.objects.iter().zip(bytes.chunks_exact_mut(stride)).enumerate() {
        place[..size_of::<ObjectLayout>()].copy_from_slice(bytemuck::bytes_of(&object_layout(scene, number, object)));
    }
    bytes
}

fn object_layout(scene: &Scene, number: usize, object: &Object) -> ObjectLayout {
    let depth = ReliefDepth::new(scene.materials[object.material].height, object);
    ObjectLayout {
        transposed: depth.transposed.to_cols_array_2d().map(|[x, y, z]| [x, y, z, 0.0]),
        repeat: object.uv_repeat.into(),
        // 0 is where there is none. Shadow maps hold 16 bits; that two of so many objects count as one does little harm.
        number: (number % 0xffff) as u32 + 1,
        pad: 0,
    }
}

/// What clears the target: the numbers that the shaders put there.
fn background(scene: &Scene, output: Output) -> wgpu::Color {
    let space = scene.shading.color_space;
    let light = match output {
        Output::AsIs | Output::Raw => space == ColorSpace::Linear,
        Output::Encoded => false,
        Output::Decoded => true,
    };
    let [r, g, b] = scene.image.background.map(|x| f64::from(if light { srgb_to_linear(x) } else { x }));
    wgpu::Color { r, g, b, a: 1.0 }
}
