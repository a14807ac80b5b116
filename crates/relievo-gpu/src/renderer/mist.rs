//! The mist of a scene on the device.

use relievo_scene::{MistVolume, Scene};

use super::formats::{SAMPLE_FORMAT, SHARE_FORMAT};
use super::layout::MAX_LIGHTS;
use super::material::MaterialResources;
use super::mist_layout::MistLayout;
use super::mist_targets::MistTargets;
use super::permutation::{MistPass, RenderPermutation};
use super::pipelines::Pipelines;
use crate::GpuError;
use crate::device::wgpu_util::{
    bind_group_layout, layout_entries, loaded_texture_type, pipeline_layout, shader_module, uniform_type,
};

/// All mist of a scene, in the order of its objects.
pub(crate) struct Mists {
    pub(super) volumes: Vec<MistVolume>,
    pub(super) layouts: Vec<MistLayout>,
    pub(super) pipelines: Vec<MistPipelines>,
    /// Bindings of group 3 of the passes over mist.
    pub(super) bindings: wgpu::BindGroupLayout,
    /// Settings, `stride` bytes apart: of each mist those for its colour, then those for each light.
    pub(super) settings: wgpu::Buffer,
    pub(super) stride: u32,
    /// True if a surface is dimmed.
    pub(super) dims: bool,
    pub(super) targets: Option<MistTargets>,
}

#[derive(Clone)]
pub(super) struct MistPipelines {
    permutation: RenderPermutation,
    pub(super) color: wgpu::RenderPipeline,
    pub(super) shadow: wgpu::RenderPipeline,
}

/// Returns the spaces that a scene's mist fills.
pub(super) fn mist_volumes(scene: &Scene) -> Result<Vec<MistVolume>, GpuError> {
    let refused = |(object, error)| GpuError::Scene(format!("object {object} cannot be mist: {error}"));
    scene.mist_volumes().map_err(refused)
}

impl Mists {
    /// Makes the mist of these spaces ready; `known` is that of the scene as it was before, whose pipelines and textures stay
    /// where they fit.
    pub(crate) fn new(
        device: &wgpu::Device,
        pipelines: &Pipelines,
        scene: &Scene,
        volumes: Vec<MistVolume>,
        materials: &[MaterialResources],
        known: Option<&Self>,
    ) -> Result<Self, GpuError> {
        let entries = [(0, uniform_type(true)), (1, loaded_texture_type())];
        let new_bindings =
            || bind_group_layout(device, "relievo mist", &layout_entries(wgpu::ShaderStages::FRAGMENT, &entries));
        let bindings = known.map_or_else(new_bindings, |known| known.bindings.clone());
        let layout = pipeline_layout(
            device,
            "relievo mist",
            &[&pipelines.view, &pipelines.surface, &pipelines.object, &bindings],
        );
        let (mut layouts, mut made) = (Vec::new(), Vec::new());
        for volume in &volumes {
            let material = &scene.materials[volume.material];
            layouts.push(MistLayout::new(volume, material, &material.mist.unwrap_or_default()));
            let permutation = materials[volume.material].permutation;
            let mut known = known.map_or(&[][..], |known| &known.pipelines).iter().chain(&made);
            let same = known.find(|known: &&MistPipelines| known.permutation == permutation).cloned();
            made.push(match same {
                Some(same) => same,
                None => MistPipelines::new(device, &layout, permutation)?,
            });
        }
        let same_size = known.filter(|known| known.volumes.len() == volumes.len());
        let alignment = device.limits().min_uniform_buffer_offset_alignment.max(1);
        let stride = (size_of::<MistLayout>() as u32).next_multiple_of(alignment);
        let slots = volumes.len().max(1) * slots_per_mist();
        let new_settings = || {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("relievo mist"),
                size: u64::from(stride) * slots as u64,
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let settings = same_size.map_or_else(new_settings, |known| known.settings.clone());
        let dims = materials.iter().any(|material| material.permutation.dimmed);
        let targets = same_size.filter(|known| known.dims == dims).and_then(|known| known.targets.clone());
        Ok(Self { volumes, layouts, pipelines: made, bindings, settings, stride, dims, targets })
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.volumes.is_empty()
    }

    /// Bindings of group 3 of surfaces that are dimmed; there once the mist is prepared for a picture.
    pub(crate) fn past_mist(&self) -> Option<&wgpu::BindGroup> {
        self.targets.as_ref().map(|targets| &targets.past_mist)
    }

    /// Uploads the settings, for this many lights.
    pub(super) fn write(&self, queue: &wgpu::Queue, lights: usize) {
        let mut bytes = vec![0; self.stride as usize * slots_per_mist()];
        for (number, layout) in self.layouts.iter().enumerate() {
            for (slot, chunk) in bytes.chunks_exact_mut(self.stride as usize).take(1 + lights).enumerate() {
                let layout = layout.for_light(slot.saturating_sub(1));
                chunk[..size_of::<MistLayout>()].copy_from_slice(bytemuck::bytes_of(&layout));
            }
            queue.write_buffer(&self.settings, u64::from(self.offset(number, None)), &bytes);
        }
    }

    /// Returns the place of a mist's settings, for its colour or for a light.
    pub(super) fn offset(&self, mist: usize, light: Option<usize>) -> u32 {
        let slot = mist * slots_per_mist() + light.map_or(0, |light| light + 1);
        slot as u32 * self.stride
    }
}

impl MistPipelines {
    fn new(
        device: &wgpu::Device,
        layout: &wgpu::PipelineLayout,
        permutation: RenderPermutation,
    ) -> Result<Self, GpuError> {
        let pipeline = |pass| mist_pipeline(device, layout, &permutation, pass);
        Ok(Self { color: pipeline(MistPass::Color)?, shadow: pipeline(MistPass::Shadow)?, permutation })
    }
}

fn slots_per_mist() -> usize {
    1 + MAX_LIGHTS
}

fn mist_pipeline(
    device: &wgpu::Device,
    layout: &wgpu::PipelineLayout,
    permutation: &RenderPermutation,
    pass: MistPass,
) -> Result<wgpu::RenderPipeline, GpuError> {
    let shader = shader_module(device, "relievo mist", permutation.mist_source(pass)?);
    let component =
        |src_factor, dst_factor| wgpu::BlendComponent { src_factor, dst_factor, operation: wgpu::BlendOperation::Add };
    use wgpu::BlendFactor::{Dst, One, SrcAlpha, Zero};
    let (format, blend) = match pass {
        // What lies behind counts as much as comes through; coverage stays.
        MistPass::Color => {
            (SAMPLE_FORMAT, wgpu::BlendState { color: component(One, SrcAlpha), alpha: component(Zero, One) })
        }
        MistPass::Shadow => {
            (SHARE_FORMAT, wgpu::BlendState { color: component(Dst, Zero), alpha: component(Zero, One) })
        }
    };
    Ok(device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("relievo mist"),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module: &shader,
            entry_point: Some("relievo_vertex"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &shader,
            entry_point: Some("relievo_fragment"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::ColorTargetState { format, blend: Some(blend), write_mask: wgpu::ColorWrites::ALL })],
        }),
        multiview_mask: None,
        cache: None,
    }))
}
