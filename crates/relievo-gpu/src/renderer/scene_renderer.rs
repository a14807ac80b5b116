use glam::Vec3;
use relievo_map::{GridId, srgb_to_linear};
use relievo_march::Shadow;
use relievo_scene::{Camera, ColorSpace, EnvironmentMap, Light, MarchSpace, Scene, Shading};

use super::attachments::Attachments;
use super::bindings::{SceneBuffers, view_bindings};
use super::check::check_variant;
use super::environment::EnvironmentTextures;
use super::formats::{DEPTH_FORMAT, SAMPLE_FORMAT};
use super::geometry::{Geometry, ObjectGeometry};
use super::live_material::LiveMaterials;
use super::material::{MaterialResources, MaterialUploader};
use super::mist::{Mists, mist_volumes};
use super::options::RendererOptions;
use super::permutation::{Casters, Output, Pass, background_source};
use super::pipelines::{Pipelines, Targets};
use super::shadows::Shadows;
use super::supersample::Supersampler;
use crate::device::guarded;
use crate::{GpuError, HeightTexture};

/// Sums of more samples than this in half floats may be off by more than a step of eight bits.
const EXACT_SAMPLES: u32 = 64;

/// A scene made ready for drawing on a device that the caller owns, into textures that the caller owns.
///
/// Draws what `relievo-cpu` draws, up to the rounding of the device and to the texels of the shadow maps, in which objects
/// throw shadows on each other.
pub struct Renderer {
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    pub(super) options: RendererOptions,
    pub(super) camera: Camera,
    /// The scene's corners.
    pub(super) bounds: [Vec3; 2],
    pub(super) shading: Shading,
    pub(super) lights: Vec<Light>,
    pub(super) background: wgpu::Color,
    output: Output,
    pub(super) samples: u32,
    pub(super) supersampler: Option<Supersampler>,
    pub(super) pipelines: Pipelines,
    /// Draws the environment where there is one.
    pub(super) sky: Option<wgpu::RenderPipeline>,
    pub(super) materials: Vec<MaterialResources>,
    /// Of each material the back of its relief, if that is drawn.
    pub(super) backs: Vec<Option<MaterialResources>>,
    /// Heights that the device makes.
    live: LiveMaterials,
    pub(super) geometry: Geometry,
    /// Material of each object.
    pub(super) object_materials: Vec<usize>,
    pub(super) buffers: SceneBuffers,
    pub(super) environment: EnvironmentTextures,
    environment_id: Option<GridId>,
    pub(super) shadows: Shadows,
    pub(super) view_bindings: wgpu::BindGroup,
    pub(super) attachments: Attachments,
    pub(super) mists: Mists,
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
        options.validate()?;
        guarded(device, || {
            let mut renderer = Self::assemble(device, queue, scene, format, options)?;
            renderer.place_lights()?;
            Ok(renderer)
        })
    }

    /// Builds all parts, and puts them together; lights are still to be placed.
    fn assemble(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
        format: wgpu::TextureFormat,
        options: &RendererOptions,
    ) -> Result<Self, GpuError> {
        let space = scene.shading.color_space;
        let output = Output::new(space, format.is_srgb());
        let samples = scene.image.samples;
        let has_mist = has_mist(scene);
        // Mist is laid over light, not over display numbers.
        let floats = samples > 1 || has_mist;
        let supersampler = floats.then(|| Supersampler::new(device, samples, format, output)).transpose()?;
        let (format, output) = if floats { (SAMPLE_FORMAT, Output::Raw) } else { (format, output) };
        let targets = Targets { format, multisample: options.msaa, after_depth: options.draws_depth_first() };
        let mut pipelines = Pipelines::new(device, targets);
        let mut live = LiveMaterials::default();
        live.update(device, queue, scene)?;
        let scene = scene.with_heights_made(|material| live.heights(material).is_some());
        let scene = &*scene.map_err(|error| GpuError::Scene(error.to_string()))?;
        let environment = scene.environment.as_ref().map(|map| EnvironmentMap::new(map, space));
        let environment_id = scene.environment.as_ref().map(|map| map.grid.id());
        let sky = match environment {
            Some(_) => Some(pipelines.background(device, background_source(scene.shading.model, output)?)),
            None => None,
        };
        let environment = EnvironmentTextures::new(device, queue, environment.as_ref())?;
        let geometry = Geometry::new(device, queue, scene)?;
        let buffers = SceneBuffers::new(device, &pipelines, scene, &geometry.shell_texture);
        let shadows = Shadows::new(device, buffers.stride);
        let (views, lights) = (&buffers.views, &buffers.lights);
        let view_bindings = view_bindings(device, &pipelines.view, views, lights, &shadows.maps, &environment);
        let volumes = mist_volumes(scene)?;
        let uploader = MaterialUploader {
            device,
            queue,
            output,
            environment: sky.is_some(),
            options,
            live: &live,
            mist: !volumes.is_empty(),
        };
        let (materials, backs) = make_materials(&uploader, &mut pipelines, scene, (&geometry, &[], &[]))?;
        let mists = Mists::new(device, &pipelines, scene, volumes, &materials, None)?;
        Ok(Self {
            device: device.clone(),
            queue: queue.clone(),
            options: *options,
            camera: scene.camera,
            bounds: scene.bounds(),
            shading: scene.shading,
            lights: scene.lights.clone(),
            background: background(scene, output),
            output,
            samples,
            supersampler,
            attachments: Attachments::new(DEPTH_FORMAT, format, options.msaa),
            pipelines,
            sky,
            materials,
            backs,
            live,
            geometry,
            object_materials: scene.objects.iter().map(|object| object.material).collect(),
            buffers,
            environment,
            environment_id,
            shadows,
            view_bindings,
            mists,
        })
    }

    /// Notes on what of the scene is drawn differently from the CPU, in words.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if self.samples > EXACT_SAMPLES {
            let samples = self.samples;
            notes.push(format!("{samples} samples per pixel are summed in half floats: colours may be some steps off"));
        }
        for (material, why) in &self.live.on_cpu {
            notes.push(format!(
                "the heights of material \"{material}\" change and are made on the CPU, and uploaded for every frame: {why}"
            ));
        }
        let left_out = self.shadows.views.left_out;
        if left_out > 0 {
            notes.push(format!("there is no room for the shadow maps of {left_out} lights: they shine through"));
        }
        let fronts = self.geometry.objects.iter().zip(&self.object_materials);
        let in_shells = fronts.filter(|(object, _)| object.space() == MarchSpace::Shell);
        if in_shells.map(|(_, &material)| self.materials[material].permutation).any(|p| p.march.shadow != Shadow::None)
        {
            notes.push(
                "reliefs with a silhouette shadow themselves as they would in the planes of their polygons".to_owned(),
            );
        }
        notes
    }

    /// Triangles in the scene, displaced grids included.
    #[must_use]
    pub fn triangles(&self) -> usize {
        self.geometry.objects.iter().map(ObjectGeometry::triangles).sum()
    }

    /// Sets the camera.
    ///
    /// # Errors
    /// If the camera looks nowhere.
    pub fn set_camera(&mut self, camera: &Camera) -> Result<(), GpuError> {
        camera.validate()?;
        self.camera = *camera;
        Ok(())
    }

    /// Sets the lights.
    ///
    /// # Errors
    /// If there are more lights than there is room for.
    pub fn set_lights(&mut self, lights: &[Light]) -> Result<(), GpuError> {
        super::view::lights(lights)?;
        self.lights = lights.to_vec();
        let device = self.device.clone();
        guarded(&device, || self.place_lights())
    }

    /// Takes over a scene at another time: everything of it that keyframes can change, and its maps and heights that change.
    /// What is the same, maps above all, is not uploaded again; heights that the device can make, see
    /// [`relievo_scene::Material::changing_heights`], are made there.
    ///
    /// # Errors
    /// If the scene has other materials, objects, samples, another environment, colour space or reflection model than the one
    /// that the renderer was made from, more lights than there is room for, or the device fails.
    pub fn set_scene(&mut self, scene: &Scene) -> Result<(), GpuError> {
        check_variant(scene, self.materials.len(), &self.object_materials)?;
        let fixed = |scene: &Shading| (scene.model, scene.color_space);
        let environment = scene.environment.as_ref().map(|map| map.grid.id());
        if fixed(&scene.shading) != fixed(&self.shading)
            || (environment, scene.image.samples) != (self.environment_id, self.samples)
        {
            let text = "it has another environment, colour space, reflection model or number of samples than the one that the \
                        renderer was made from";
            return Err(GpuError::Scene(text.to_owned()));
        }
        super::view::lights(&scene.lights)?;
        let device = self.device.clone();
        guarded(&device, || {
            self.live.update(&self.device, &self.queue, scene)?;
            let made = scene.with_heights_made(|material| self.live.heights(material).is_some());
            let scene = &*made.map_err(|error| GpuError::Scene(error.to_string()))?;
            let geometry = if self.geometry.is_right_for(scene) {
                None
            } else {
                Some(Geometry::new(&self.device, &self.queue, scene)?)
            };
            self.remake_materials(scene, geometry.as_ref())?;
            if let Some(geometry) = geometry {
                self.buffers.set_shells(&self.device, &self.pipelines, &geometry.shell_texture);
                self.geometry = geometry;
            }
            self.buffers.write_objects(&self.queue, scene);
            self.bounds = scene.bounds();
            (self.camera, self.shading) = (scene.camera, scene.shading);
            self.background = background(scene, self.output);
            self.lights = scene.lights.clone();
            self.place_lights()
        })
    }

    /// Takes over from a scene how deep its materials are and how their reliefs are drawn: `height_scale` or `depth`,
    /// `midlevel` and everything under `relief`. All else must be as in the scene the renderer was made from; maps are not
    /// uploaded again.
    ///
    /// # Errors
    /// If the scene has other materials or objects, or the device fails.
    pub fn set_reliefs(&mut self, scene: &Scene) -> Result<(), GpuError> {
        check_variant(scene, self.materials.len(), &self.object_materials)?;
        let device = self.device.clone();
        guarded(&device, || {
            self.live.update(&self.device, &self.queue, scene)?;
            let made = scene.with_heights_made(|material| self.live.heights(material).is_some());
            let scene = &*made.map_err(|error| GpuError::Scene(error.to_string()))?;
            // Everything is made before anything is changed.
            let geometry = if self.geometry.is_right_for(scene) {
                None
            } else {
                Some(Geometry::new(&self.device, &self.queue, scene)?)
            };
            self.remake_materials(scene, geometry.as_ref())?;
            if let Some(geometry) = geometry {
                self.buffers.set_shells(&self.device, &self.pipelines, &geometry.shell_texture);
                self.geometry = geometry;
            }
            self.place_lights()
        })
    }

    /// Marches a material's relief through these heights from now on, instead of through its own map: those of a
    /// [`crate::LiveHeights`] change as the caller has them change. `scene` is as for [`Renderer::set_reliefs`]. The
    /// material's other maps stay, so it should have no normal map: without one normals follow the heights. Displaced grids
    /// do not move, and a relief with two sides is drawn from its front alone.
    ///
    /// # Errors
    /// As [`Renderer::set_reliefs`], or if there is no such material.
    pub fn set_heights(&mut self, scene: &Scene, material: usize, heights: &HeightTexture) -> Result<(), GpuError> {
        check_variant(scene, self.materials.len(), &self.object_materials)?;
        let count = self.materials.len();
        let Some(resources) = self.materials.get_mut(material) else {
            return Err(GpuError::InvalidArgument(format!("there is no material {material} among {count}")));
        };
        resources.set_heights(heights);
        let device = self.device.clone();
        guarded(&device, || {
            self.remake_materials(scene, None)?;
            self.place_lights()
        })
    }

    /// Marks the heights as changed on the device: shadow maps are drawn anew with the next picture.
    pub fn heights_changed(&mut self) {
        self.shadows.drawn = false;
    }

    /// Shadow maps as they were drawn last, in the order of the lights: a layer for each, and six for a point light or a
    /// spot wider than 70° from its axis (its views along +x, −x, +y, −y, +z, −z, 90° wide); none for lights that no caster
    /// stands in, and at the end one that is empty where OpenGL needs it. In [`Renderer::DEPTH_FORMAT`], with usage COPY_SRC
    /// and TEXTURE_BINDING; of one texel if the scene needs none.
    #[must_use]
    pub fn shadow_maps(&self) -> &wgpu::Texture {
        &self.shadows.maps.texture
    }

    /// Makes the materials anew, for new geometry or the one that there is.
    fn remake_materials(&mut self, scene: &Scene, geometry: Option<&Geometry>) -> Result<(), GpuError> {
        let volumes = mist_volumes(scene)?;
        let uploader = MaterialUploader {
            device: &self.device,
            queue: &self.queue,
            output: self.output,
            environment: self.sky.is_some(),
            options: &self.options,
            live: &self.live,
            mist: !volumes.is_empty(),
        };
        let known = (geometry.unwrap_or(&self.geometry), &self.materials[..], &self.backs[..]);
        let (materials, backs) = make_materials(&uploader, &mut self.pipelines, scene, known)?;
        self.mists = Mists::new(&self.device, &self.pipelines, scene, volumes, &materials, Some(&self.mists))?;
        (self.materials, self.backs) = (materials, backs);
        Ok(())
    }

    pub(super) fn make_pipelines(&mut self, kind: Pass) -> Result<(), GpuError> {
        let fronts = self.geometry.objects.iter().zip(&self.object_materials);
        let fronts = fronts.map(|(object, &material)| (object, Some(&self.materials[material])));
        let backs = self.geometry.backs.iter();
        let backs = backs.map(|(number, object)| (object, self.backs[self.object_materials[*number]].as_ref()));
        for (object, material) in fronts.chain(backs) {
            let Some(material) = material.filter(|material| !material.is_mist()) else { continue };
            self.pipelines.make(&self.device, &material.permutation.drawn_by(object.drawn_geometry(kind)), kind)?;
        }
        Ok(())
    }

    /// Uploads the lights, and plans their shadow maps if a material asks for them.
    fn place_lights(&mut self) -> Result<(), GpuError> {
        let wanted = self.materials.iter().any(|material| material.permutation.casters != Casters::Nothing);
        let layouts = self.shadows.plan(&self.lights, wanted.then_some(&self.geometry.casters[..]))?;
        self.queue.write_buffer(&self.buffers.lights, 0, bytemuck::cast_slice(&layouts));
        if !self.shadows.views.layers.is_empty() {
            self.make_pipelines(Pass::Caster)?;
        }
        Ok(())
    }
}

/// The materials of a scene and their backs.
type Sides = (Vec<MaterialResources>, Vec<Option<MaterialResources>>);

/// Makes the materials ready, from the maps of `known` where those are the same, and the pipelines that draw them.
fn make_materials(
    uploader: &MaterialUploader<'_>,
    pipelines: &mut Pipelines,
    scene: &Scene,
    (geometry, known, known_backs): (&Geometry, &[MaterialResources], &[Option<MaterialResources>]),
) -> Result<Sides, GpuError> {
    let mut materials = Vec::with_capacity(scene.materials.len());
    let mut backs = Vec::with_capacity(scene.materials.len());
    for (number, material) in scene.materials.iter().enumerate() {
        let objects = || geometry.objects.iter().zip(&scene.objects).filter(|(_, object)| object.material == number);
        let tiled = objects().any(|(object, _)| object.tiled);
        let made = uploader.make(&pipelines.surface, &scene.shading, (number, material), tiled, known.get(number))?;
        // Heights of the caller's have no back: they may change at any time.
        let back = (material.has_marched_back() && !made.is_given()).then(|| {
            let known = known_backs.get(number).and_then(Option::as_ref);
            uploader.make_back(&pipelines.surface, &scene.shading, (number, material), tiled, (&made, known))
        });
        let back = back.transpose()?;
        let surfaces = std::iter::once(&made).filter(|made| !made.is_mist());
        for (side, (object, _)) in surfaces.chain(&back).flat_map(|side| objects().map(move |o| (side, o))) {
            pipelines.make(
                uploader.device,
                &side.permutation.drawn_by(object.drawn_geometry(Pass::Color)),
                Pass::Color,
            )?;
            if uploader.options.depth_prepass {
                pipelines.make(
                    uploader.device,
                    &side.permutation.drawn_by(object.drawn_geometry(Pass::Depth)),
                    Pass::Depth,
                )?;
            }
        }
        materials.push(made);
        backs.push(back);
    }
    Ok((materials, backs))
}

fn has_mist(scene: &Scene) -> bool {
    scene.objects.iter().any(|object| scene.materials[object.material].is_mist())
}

/// Colour that clears the target: the numbers that the shaders put there.
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
