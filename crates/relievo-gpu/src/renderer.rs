use std::num::NonZeroU64;

use glam::Vec2;
use relievo_map::srgb_to_linear;
use relievo_march::Shadow;
use relievo_scene::{Camera, ColorSpace, Light, Object, ReliefDepth, Scene, Shading};
use wgpu::util::DeviceExt;

use crate::GpuError;
use crate::error::guarded;
use crate::geometry::Geometry;
use crate::height_texture::check_size;
use crate::layout::{LightLayout, MAX_LIGHTS, ObjectLayout, ViewLayout};
use crate::look::{Look, Studio};
use crate::pipelines::{DEPTH_FORMAT, Pipelines};
use crate::render_permutation::{Output, Pass};
use crate::supersample::{SAMPLE_FORMAT, Supersampler};
use crate::view::{self, Sample};

/// More samples per pixel than this are a mistake.
const MAX_SAMPLES: u32 = 4096;

/// How to draw, beside what the scene says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RendererOptions {
    /// Samples along a stretched footprint, for materials with `filter = "trilinear"`: 1 (as the CPU draws) to 16.
    pub anisotropy: u16,
}

impl Default for RendererOptions {
    fn default() -> Self {
        Self { anisotropy: 1 }
    }
}

/// A scene made ready for drawing on a device that the caller owns, into textures that the caller owns.
///
/// Draws what `relievo-cpu` draws, up to the rounding of the device.
pub struct Renderer {
    device: wgpu::Device,
    queue: wgpu::Queue,
    camera: Camera,
    shading: Shading,
    light_count: usize,
    background: wgpu::Color,
    samples: u32,
    supersampler: Option<Supersampler>,
    pipelines: Pipelines,
    looks: Vec<Look>,
    geometry: Geometry,
    /// The material of each object.
    materials: Vec<usize>,
    view: wgpu::Buffer,
    lights: wgpu::Buffer,
    view_bindings: wgpu::BindGroup,
    object_bindings: wgpu::BindGroup,
    /// Distance of one sample's view, or one object, to the next in its buffer.
    stride: u32,
    depth: Option<([u32; 2], wgpu::TextureView)>,
    notes: Vec<String>,
}

/// Where a picture goes.
#[derive(Clone, Copy, Debug)]
pub struct Target<'a> {
    /// In the format given to [`Renderer::new`], with usage RENDER_ATTACHMENT. All of it is drawn over.
    pub color: &'a wgpu::TextureView,
    /// For what else the caller draws: in [`Renderer::DEPTH_FORMAT`], with usage RENDER_ATTACHMENT. 1 = on the camera's
    /// near plane, 0 = at infinity: near divided by the distance along the camera's axis. Without, the renderer has its
    /// own. With several samples per pixel it ends up with the last one's.
    pub depth: Option<&'a wgpu::TextureView>,
    /// Width and height of the views in pixels.
    pub size: [u32; 2],
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
        check(scene)?;
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
        let mut pipelines = Pipelines::new(device, format);
        let layout = pipelines.surface.clone();
        let anisotropy = options.anisotropy.clamp(1, 16);
        let studio = Studio { device, queue, layout: &layout, space, model: scene.shading.model, output, anisotropy };
        let mut looks = Vec::with_capacity(scene.materials.len());
        for (number, material) in scene.materials.iter().enumerate() {
            let repeats = scene.objects.iter().any(|o| o.material == number && o.uv_repeat != Vec2::ONE);
            let look = studio.look(material, repeats)?;
            pipelines.make(device, &look.permutation, Pass::Color)?;
            looks.push(look);
        }
        let geometry = Geometry::new(device, scene)?;
        let layouts = view::lights(&scene.lights)?;
        let uniform = |label, contents: &[u8]| {
            let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage })
        };
        let alignment = device.limits().min_uniform_buffer_offset_alignment;
        let stride = alignment.max(size_of::<ObjectLayout>().max(size_of::<ViewLayout>()) as u32);
        let stride = stride.next_multiple_of(alignment.max(1));
        let view = uniform("relievo view", &vec![0; stride as usize * samples as usize]);
        let lights = uniform("relievo lights", bytemuck::cast_slice(&layouts));
        let objects = uniform("relievo objects", &object_bytes(scene, stride as usize));
        let bindings = |layout, resources: &[wgpu::BindingResource<'_>]| {
            let places = resources.iter().cloned().enumerate();
            let entries: Vec<_> =
                places.map(|(k, resource)| wgpu::BindGroupEntry { binding: k as u32, resource }).collect();
            device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("relievo"), layout, entries: &entries })
        };
        let one = |buffer, size: usize| {
            let size = NonZeroU64::new(size as u64);
            wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset: 0, size })
        };
        let view_bindings =
            bindings(&pipelines.view, &[one(&view, size_of::<ViewLayout>()), lights.as_entire_binding()]);
        let object_bindings = bindings(&pipelines.object, &[one(&objects, size_of::<ObjectLayout>())]);
        Ok(Self {
            device: device.clone(),
            queue: queue.clone(),
            camera: scene.camera,
            shading: scene.shading,
            light_count: scene.lights.len(),
            background: background(scene, output),
            samples,
            supersampler,
            pipelines,
            looks,
            geometry,
            materials: scene.objects.iter().map(|object| object.material).collect(),
            view,
            lights,
            view_bindings,
            object_bindings,
            stride,
            depth: None,
            notes: notes(scene),
        })
    }

    /// What of the scene is drawn differently from the CPU, in words.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Looks from elsewhere from now on.
    ///
    /// # Errors
    /// If the camera looks nowhere.
    pub fn set_camera(&mut self, camera: &Camera) -> Result<(), GpuError> {
        view::check(camera)?;
        self.camera = *camera;
        Ok(())
    }

    /// Lights the scene differently from now on.
    ///
    /// # Errors
    /// If there are more lights than there is room for.
    pub fn set_lights(&mut self, lights: &[Light]) -> Result<(), GpuError> {
        let layouts: [LightLayout; MAX_LIGHTS] = view::lights(lights)?;
        self.queue.write_buffer(&self.lights, 0, bytemuck::cast_slice(&layouts));
        self.light_count = lights.len();
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
    /// as [`Target::depth`]; the sample is the one in the pixels' middle.
    ///
    /// # Errors
    /// As [`Renderer::draw`].
    pub fn draw_depth(&mut self, depth: &wgpu::TextureView, size: [u32; 2]) -> Result<(), GpuError> {
        self.submitted(|this, encoder| this.record_depth(encoder, depth, size))
    }

    fn submitted(
        &mut self,
        record: impl FnOnce(&mut Self, &mut wgpu::CommandEncoder) -> Result<(), GpuError>,
    ) -> Result<(), GpuError> {
        let device = self.device.clone();
        guarded(&device, || {
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            record(self, &mut encoder)?;
            self.queue.submit([encoder.finish()]);
            Ok(())
        })
    }

    /// [`Renderer::draw`] as part of the caller's own commands, which must be submitted before the next ones are recorded.
    /// Failures of the device come up where those are submitted.
    ///
    /// # Errors
    /// If a side of the size is 0 or over the device's limit.
    pub fn record(&mut self, encoder: &mut wgpu::CommandEncoder, target: &Target<'_>) -> Result<(), GpuError> {
        self.look(target.size)?;
        let depth = target.depth.cloned().unwrap_or_else(|| self.depth_view(target.size));
        let Some(supersampler) = &mut self.supersampler else {
            self.pass(encoder, Some(target.color), &depth, 0);
            return Ok(());
        };
        let picture = supersampler.target(&self.device, target.size);
        for index in 0..self.samples {
            self.pass(encoder, Some(&picture), &depth, index);
            if let Some(supersampler) = &self.supersampler {
                supersampler.add(encoder, index == 0);
            }
        }
        if let Some(supersampler) = &self.supersampler {
            supersampler.resolve(encoder, target.color);
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
        for look in &self.looks {
            self.pipelines.make(&self.device, &look.permutation, Pass::Depth)?;
        }
        self.pass(encoder, None, depth, 0);
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
            let layout = view::view(&self.camera, &self.shading, self.light_count, size, sample);
            self.queue.write_buffer(&self.view, u64::from(index * self.stride), bytemuck::bytes_of(&layout));
        }
        Ok(())
    }

    /// Draws one sample of everything: depth alone where there is no colour.
    fn pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        color: Option<&wgpu::TextureView>,
        depth: &wgpu::TextureView,
        sample: u32,
    ) {
        let attachment = color.map(|view| wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(self.background), store: wgpu::StoreOp::Store },
        });
        let (attachments, kind) = match color {
            Some(_) => (&[attachment] as &[_], Pass::Color),
            None => (&[] as &[_], Pass::Depth),
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("relievo"),
            color_attachments: attachments,
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_bind_group(0, &self.view_bindings, &[sample * self.stride]);
        pass.set_vertex_buffer(0, self.geometry.vertices.slice(..));
        pass.set_index_buffer(self.geometry.indices.slice(..), wgpu::IndexFormat::Uint32);
        for (number, (indices, &material)) in self.geometry.objects.iter().zip(&self.materials).enumerate() {
            let look = &self.looks[material];
            let Some(pipeline) = self.pipelines.get(&look.permutation, kind) else { continue };
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
        let texture = self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("relievo depth"),
            size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: Renderer::DEPTH_FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        self.depth = Some((size, view.clone()));
        view
    }
}

/// The settings of all objects, each at a multiple of `stride`; at least one, so that there is something to bind.
fn object_bytes(scene: &Scene, stride: usize) -> Vec<u8> {
    let mut bytes = vec![0; stride * scene.objects.len().max(1)];
    for (object, place) in scene.objects.iter().zip(bytes.chunks_exact_mut(stride)) {
        place[..size_of::<ObjectLayout>()].copy_from_slice(bytemuck::bytes_of(&object_layout(scene, object)));
    }
    bytes
}

fn object_layout(scene: &Scene, object: &Object) -> ObjectLayout {
    let depth = ReliefDepth::new(scene.materials[object.material].height, object);
    ObjectLayout {
        transposed: depth.transposed.to_cols_array_2d().map(|[x, y, z]| [x, y, z, 0.0]),
        repeat: object.uv_repeat.into(),
        pad: [0; 2],
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

fn notes(scene: &Scene) -> Vec<String> {
    let mut notes = Vec::new();
    if scene.environment.is_some() {
        notes.push("the environment is not drawn on the GPU yet".to_owned());
    }
    let shadows_others = |material: &relievo_scene::Material| material.relief.shadow == Shadow::Exact;
    if scene.objects.len() > 1 && scene.materials.iter().any(shadows_others) {
        notes.push("objects do not throw shadows on each other on the GPU yet".to_owned());
    }
    let displaced = |material: &relievo_scene::Material| {
        material.relief.technique == relievo_scene::SurfaceTechnique::Displacement
            && material.relief.shadow != Shadow::None
    };
    if scene.materials.iter().any(displaced) {
        notes.push("displaced geometry does not shadow itself on the GPU yet".to_owned());
    }
    notes
}

/// The promises of a scene that drawing relies on.
fn check(scene: &Scene) -> Result<(), GpuError> {
    view::check(&scene.camera)?;
    let samples = scene.image.samples;
    if samples == 0 || samples > MAX_SAMPLES {
        return Err(GpuError::Scene(format!("{samples} samples per pixel are not possible: 1 to {MAX_SAMPLES} are")));
    }
    for (i, object) in scene.objects.iter().enumerate() {
        let broken = |what: String| Err(GpuError::Scene(format!("object {i} {what}")));
        if object.material >= scene.materials.len() {
            return broken(format!("asks for material {} of {}", object.material, scene.materials.len()));
        }
        if !object.transform.is_finite() || object.transform.matrix3.determinant() == 0.0 {
            return broken("is squeezed flat by its transform".to_owned());
        }
        if let Err(error) = object.mesh.validate() {
            return broken(format!("has a mesh that cannot be drawn: {error}"));
        }
    }
    Ok(())
}
