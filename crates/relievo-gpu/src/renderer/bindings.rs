//! Bind groups 0 (view) and 2 (object), and the buffers behind them.

use relievo_scene::{Object, ReliefDepth, Scene};
use wgpu::util::DeviceExt;

use super::environment::EnvironmentTextures;
use super::layout::{CameraViewLayout, LightLayout, MAX_LIGHTS, ObjectLayout};
use super::pipelines::Pipelines;
use super::shadow_maps::ShadowMaps;
use crate::device::wgpu_util::{bind_group, one_of, view};

/// Buffers of a whole picture, and the bindings of all objects.
pub(crate) struct SceneBuffers {
    /// Camera views, one for each sample, `stride` bytes apart.
    pub(crate) views: wgpu::Buffer,
    pub(crate) lights: wgpu::Buffer,
    /// Settings of all objects.
    objects: wgpu::Buffer,
    pub(crate) object_bindings: wgpu::BindGroup,
    /// Distance of one sample's view, or one object, to the next in its buffer.
    pub(crate) stride: u32,
}

impl SceneBuffers {
    pub(crate) fn new(device: &wgpu::Device, pipelines: &Pipelines, scene: &Scene, shells: &wgpu::TextureView) -> Self {
        let uniform = |label, contents: &[u8]| {
            let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage })
        };
        let alignment = device.limits().min_uniform_buffer_offset_alignment;
        let stride = alignment.max(size_of::<ObjectLayout>().max(size_of::<CameraViewLayout>()) as u32);
        let stride = stride.next_multiple_of(alignment.max(1));
        let objects = uniform("relievo objects", &object_bytes(scene, stride as usize));
        Self {
            views: uniform("relievo view", &vec![0; stride as usize * scene.image.samples as usize]),
            lights: uniform("relievo lights", &[0; size_of::<LightLayout>() * MAX_LIGHTS]),
            object_bindings: object_bindings(device, pipelines, &objects, shells),
            objects,
            stride,
        }
    }

    /// Takes over where the objects of a scene are; as many as there were.
    pub(crate) fn write_objects(&self, queue: &wgpu::Queue, scene: &Scene) {
        queue.write_buffer(&self.objects, 0, &object_bytes(scene, self.stride as usize));
    }

    /// Binds another texture of shells.
    pub(crate) fn set_shells(&mut self, device: &wgpu::Device, pipelines: &Pipelines, shells: &wgpu::TextureView) {
        self.object_bindings = object_bindings(device, pipelines, &self.objects, shells);
    }
}

/// Bind group 2.
fn object_bindings(
    device: &wgpu::Device,
    pipelines: &Pipelines,
    objects: &wgpu::Buffer,
    shells: &wgpu::TextureView,
) -> wgpu::BindGroup {
    let resources = vec![(0, one_of(objects, size_of::<ObjectLayout>())), (1, view(shells))];
    bind_group(device, "relievo object", &pipelines.object, resources)
}

/// Bind group 0: `views` are the cameras', or a shadow map's.
pub(crate) fn view_bindings(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    views: &wgpu::Buffer,
    lights: &wgpu::Buffer,
    shadows: &ShadowMaps,
    environment: &EnvironmentTextures,
) -> wgpu::BindGroup {
    let resources = vec![
        (0, one_of(views, size_of::<CameraViewLayout>())),
        (1, lights.as_entire_binding()),
        (2, view(&shadows.depths)),
        (3, view(&shadows.objects)),
        (4, view(&environment.picture)),
        (5, view(&environment.blurred)),
        (6, wgpu::BindingResource::Sampler(&environment.sampler)),
        (7, environment.harmonics.as_entire_binding()),
    ];
    bind_group(device, "relievo view", layout, resources)
}

/// Settings of all objects, each at a multiple of `stride`; at least one, so that there is something to bind.
fn object_bytes(scene: &Scene, stride: usize) -> Vec<u8> {
    let mut bytes = vec![0; stride * scene.objects.len().max(1)];
    for (number, (object, slot)) in scene.objects.iter().zip(bytes.chunks_exact_mut(stride)).enumerate() {
        slot[..size_of::<ObjectLayout>()].copy_from_slice(bytemuck::bytes_of(&object_layout(scene, number, object)));
    }
    bytes
}

fn object_layout(scene: &Scene, number: usize, object: &Object) -> ObjectLayout {
    let material = &scene.materials[object.material];
    let depth = ReliefDepth::new(material.height, object);
    ObjectLayout {
        transposed: depth.transposed.to_cols_array_2d().map(|[x, y, z]| [x, y, z, 0.0]),
        // 0 is where there is none. Shadow maps hold 16 bits; that two of so many objects count as one does little harm.
        number: (number % 0xffff) as u32 + 1,
        pad: [0; 3],
    }
}
