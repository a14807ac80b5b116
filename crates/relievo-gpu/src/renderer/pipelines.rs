//! The render pipelines, one per permutation, made when first needed.

use std::collections::HashMap;

use super::formats::{DEPTH_FORMAT, MEASURE_FORMAT, OBJECT_FORMAT};
use super::layout::{ShellInstance, VertexLayout};
use super::permutation::{DrawnGeometry, Pass, RenderPermutation};
use crate::GpuError;
use crate::device::wgpu_util::{
    bind_group_layout, layout_entries, loaded_texture_type, pipeline_layout, shader_module, texture_type, uniform_type,
};

pub(crate) struct Pipelines {
    pub(crate) view: wgpu::BindGroupLayout,
    pub(crate) surface: wgpu::BindGroupLayout,
    pub(crate) object: wgpu::BindGroupLayout,
    layout: wgpu::PipelineLayout,
    /// Bindings of group 3 of surfaces that mist dims.
    pub(crate) past_mist: wgpu::BindGroupLayout,
    dimmed_layout: wgpu::PipelineLayout,
    view_layout: wgpu::PipelineLayout,
    pub(crate) targets: Targets,
    made: HashMap<(RenderPermutation, Pass), wgpu::RenderPipeline>,
}

/// Targets of colours.
#[derive(Clone, Copy)]
pub(crate) struct Targets {
    pub(crate) format: wgpu::TextureFormat,
    /// Samples that the hardware takes of each pixel.
    pub(crate) multisample: u32,
    /// True if depth has been drawn before.
    pub(crate) after_depth: bool,
}

impl Pipelines {
    pub(crate) fn new(device: &wgpu::Device, targets: Targets) -> Self {
        let view = bind_group_layout(device, "relievo view", &view_entries());
        let surface = bind_group_layout(device, "relievo surface", &surface_entries());
        let shells = texture_type(wgpu::TextureSampleType::Uint, wgpu::TextureViewDimension::D2);
        let object = [(0, uniform_type(true)), (1, shells)];
        let object = layout_entries(wgpu::ShaderStages::VERTEX_FRAGMENT, &object);
        let object = bind_group_layout(device, "relievo object", &object);
        let view_layout = pipeline_layout(device, "relievo", &[&view]);
        let layout = pipeline_layout(device, "relievo", &[&view, &surface, &object]);
        let array =
            texture_type(wgpu::TextureSampleType::Float { filterable: false }, wgpu::TextureViewDimension::D2Array);
        let past_mist = layout_entries(wgpu::ShaderStages::FRAGMENT, &[(0, array)]);
        let past_mist = bind_group_layout(device, "relievo lights past mist", &past_mist);
        let dimmed_layout = pipeline_layout(device, "relievo", &[&view, &surface, &object, &past_mist]);
        Self { view, surface, object, layout, past_mist, dimmed_layout, view_layout, targets, made: HashMap::new() }
    }

    pub(crate) fn get(&self, permutation: &RenderPermutation, pass: Pass) -> Option<&wgpu::RenderPipeline> {
        self.made.get(&(*permutation, pass))
    }

    /// Makes the pipeline unless there is one.
    pub(crate) fn make(
        &mut self,
        device: &wgpu::Device,
        permutation: &RenderPermutation,
        pass: Pass,
    ) -> Result<(), GpuError> {
        if self.made.contains_key(&(*permutation, pass)) {
            return Ok(());
        }
        let shader = shader_module(device, "relievo", permutation.source(pass)?);
        let buffer = match permutation.geometry {
            DrawnGeometry::Polygons => wgpu::VertexBufferLayout {
                array_stride: size_of::<VertexLayout>() as u64,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &VertexLayout::ATTRIBUTES,
            },
            DrawnGeometry::Lids | DrawnGeometry::Hulls => wgpu::VertexBufferLayout {
                array_stride: size_of::<ShellInstance>() as u64,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes: &ShellInstance::ATTRIBUTES,
            },
        };
        let color = Some(self.color_target());
        let plain = |format: wgpu::TextureFormat| Some(wgpu::ColorTargetState::from(format));
        let targets: &[_] = match pass {
            Pass::Color => &[color],
            Pass::Depth => &[],
            Pass::Caster => &[plain(OBJECT_FORMAT)],
            Pass::MeasureSurface => &[plain(MEASURE_FORMAT), plain(MEASURE_FORMAT)],
            Pass::MeasureLight => &[plain(MEASURE_FORMAT)],
        };
        let cull_mode = match permutation.geometry {
            DrawnGeometry::Lids => Some(wgpu::Face::Back),
            // The far side of a hull is there for an eye inside it, too.
            DrawnGeometry::Hulls => Some(wgpu::Face::Front),
            // What a light cannot get through has no front.
            DrawnGeometry::Polygons => (permutation.one_sided && pass != Pass::Caster).then_some(wgpu::Face::Back),
        };
        let multisample = if pass == Pass::Color { self.multisample(permutation) } else { Default::default() };
        let after_depth = pass == Pass::Color && self.targets.after_depth;
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("relievo"),
            layout: Some(if permutation.looks_up_mist(pass) { &self.dimmed_layout } else { &self.layout }),
            vertex: wgpu::VertexState {
                module: &shader,
                entry_point: Some("relievo_vertex"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[Some(buffer)],
            },
            primitive: wgpu::PrimitiveState { cull_mode, ..wgpu::PrimitiveState::default() },
            depth_stencil: Some(depth_state(if after_depth {
                wgpu::CompareFunction::GreaterEqual
            } else {
                wgpu::CompareFunction::Greater
            })),
            multisample,
            fragment: Some(wgpu::FragmentState {
                module: &shader,
                entry_point: Some("relievo_fragment"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets,
            }),
            multiview_mask: None,
            cache: None,
        });
        self.made.insert((*permutation, pass), pipeline);
        Ok(())
    }

    /// The pipeline that draws the environment behind everything.
    pub(crate) fn background(&self, device: &wgpu::Device, source: String) -> wgpu::RenderPipeline {
        let shader = shader_module(device, "relievo background", source);
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("relievo background"),
            layout: Some(&self.view_layout),
            vertex: wgpu::VertexState {
                module: &shader,
                entry_point: Some("relievo_vertex"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                depth_write_enabled: Some(false),
                ..depth_state(wgpu::CompareFunction::Always)
            }),
            multisample: wgpu::MultisampleState { count: self.targets.multisample, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module: &shader,
                entry_point: Some("relievo_fragment"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(self.targets.format.into())],
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    fn color_target(&self) -> wgpu::ColorTargetState {
        wgpu::ColorTargetState {
            format: self.targets.format,
            blend: None,
            // Alpha is the share of the pixel's samples that is covered; in the picture it stays 1.
            write_mask: if self.targets.multisample > 1 { wgpu::ColorWrites::COLOR } else { wgpu::ColorWrites::ALL },
        }
    }

    fn multisample(&self, permutation: &RenderPermutation) -> wgpu::MultisampleState {
        let count = self.targets.multisample;
        let alpha_to_coverage_enabled = count > 1 && permutation.smooths_edges;
        wgpu::MultisampleState { count, alpha_to_coverage_enabled, ..Default::default() }
    }
}

const SAMPLER: wgpu::BindingType = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);

const FILTERABLE: wgpu::TextureSampleType = wgpu::TextureSampleType::Float { filterable: true };

fn depth_state(compare: wgpu::CompareFunction) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format: DEPTH_FORMAT,
        depth_write_enabled: Some(true),
        depth_compare: Some(compare),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    }
}

/// Bindings of group 0.
fn view_entries() -> Vec<wgpu::BindGroupLayoutEntry> {
    let array = wgpu::TextureViewDimension::D2Array;
    let uniforms = [(0, uniform_type(true)), (1, uniform_type(false)), (7, uniform_type(false))];
    let textures = [
        (2, texture_type(wgpu::TextureSampleType::Float { filterable: false }, array)),
        (3, texture_type(wgpu::TextureSampleType::Uint, array)),
        (4, texture_type(FILTERABLE, wgpu::TextureViewDimension::D2)),
        (5, texture_type(FILTERABLE, array)),
        (6, SAMPLER),
    ];
    let mut entries = layout_entries(wgpu::ShaderStages::VERTEX_FRAGMENT, &uniforms);
    entries.extend(layout_entries(wgpu::ShaderStages::FRAGMENT, &textures));
    entries
}

/// Bindings of group 1.
fn surface_entries() -> Vec<wgpu::BindGroupLayoutEntry> {
    let mut textures = vec![(1, loaded_texture_type())];
    textures.extend((2..7).map(|binding| (binding, texture_type(FILTERABLE, wgpu::TextureViewDimension::D2))));
    textures.push((7, SAMPLER));
    let unsigned = texture_type(wgpu::TextureSampleType::Uint, wgpu::TextureViewDimension::D2);
    textures.extend([(8, unsigned), (9, unsigned)]);
    let mut entries = layout_entries(wgpu::ShaderStages::VERTEX_FRAGMENT, &[(0, uniform_type(false))]);
    entries.extend(layout_entries(wgpu::ShaderStages::FRAGMENT, &textures));
    entries
}
