//! The render pipelines, one per permutation, made when first needed.

use std::collections::HashMap;

use crate::GpuError;
use crate::layout::VertexLayout;
use crate::render_permutation::{Pass, RenderPermutation};
use crate::shadow_maps::OBJECT_FORMAT;

/// Depth runs from 1 at the near plane to 0 at infinity: with floats, precise everywhere.
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// What numbers are measured in.
pub(crate) const MEASURE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

pub(crate) struct Pipelines {
    pub(crate) view: wgpu::BindGroupLayout,
    pub(crate) surface: wgpu::BindGroupLayout,
    pub(crate) object: wgpu::BindGroupLayout,
    layout: wgpu::PipelineLayout,
    view_layout: wgpu::PipelineLayout,
    pub(crate) targets: Targets,
    made: HashMap<(RenderPermutation, Pass), wgpu::RenderPipeline>,
}

/// What colours are drawn into, and how.
#[derive(Clone, Copy)]
pub(crate) struct Targets {
    pub(crate) format: wgpu::TextureFormat,
    /// Samples that the hardware takes of each pixel.
    pub(crate) multisample: u32,
    /// Whether depth has been drawn before.
    pub(crate) after_depth: bool,
}

impl Pipelines {
    pub(crate) fn new(device: &wgpu::Device, targets: Targets) -> Self {
        let bind_group = |label, entries: &[wgpu::BindGroupLayoutEntry]| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
        };
        let array = wgpu::TextureViewDimension::D2Array;
        let view = bind_group(
            "relievo view",
            &[
                uniform(0, true),
                uniform(1, false),
                texture(2, wgpu::TextureSampleType::Float { filterable: false }, array),
                texture(3, wgpu::TextureSampleType::Uint, array),
                texture(4, FILTERABLE, wgpu::TextureViewDimension::D2),
                texture(5, FILTERABLE, array),
                sampler(6),
                uniform(7, false),
            ],
        );
        let heights = wgpu::TextureSampleType::Float { filterable: false };
        let mut entries = vec![uniform(0, false), texture(1, heights, wgpu::TextureViewDimension::D2)];
        entries.extend((2..7).map(|binding| texture(binding, FILTERABLE, wgpu::TextureViewDimension::D2)));
        entries.push(sampler(7));
        let codes =
            [8, 9].map(|binding| texture(binding, wgpu::TextureSampleType::Uint, wgpu::TextureViewDimension::D2));
        entries.extend(codes);
        let surface = bind_group("relievo surface", &entries);
        let object = bind_group("relievo object", &[uniform(0, true)]);
        let layout = |groups: &[Option<&wgpu::BindGroupLayout>]| {
            device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some("relievo"),
                bind_group_layouts: groups,
                immediate_size: 0,
            })
        };
        let (view_layout, layout) = (layout(&[Some(&view)]), layout(&[Some(&view), Some(&surface), Some(&object)]));
        Self { view, surface, object, layout, view_layout, targets, made: HashMap::new() }
    }

    pub(crate) fn get(&self, permutation: &RenderPermutation, pass: Pass) -> Option<&wgpu::RenderPipeline> {
        self.made.get(&(*permutation, pass))
    }

    /// Makes the pipeline unless it is there.
    pub(crate) fn make(
        &mut self,
        device: &wgpu::Device,
        permutation: &RenderPermutation,
        pass: Pass,
    ) -> Result<(), GpuError> {
        if self.made.contains_key(&(*permutation, pass)) {
            return Ok(());
        }
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("relievo"),
            source: wgpu::ShaderSource::Wgsl(permutation.source(pass)?.into()),
        });
        let buffer = wgpu::VertexBufferLayout {
            array_stride: size_of::<VertexLayout>() as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &VertexLayout::ATTRIBUTES,
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
        // What a light cannot get through has no front.
        let culls = permutation.one_sided && pass != Pass::Caster;
        let multisample = if pass == Pass::Color { self.multisample(permutation) } else { Default::default() };
        let after_depth = pass == Pass::Color && self.targets.after_depth;
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("relievo"),
            layout: Some(&self.layout),
            vertex: wgpu::VertexState {
                module: &shader,
                entry_point: Some("vertex"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[Some(buffer)],
            },
            primitive: wgpu::PrimitiveState {
                cull_mode: culls.then_some(wgpu::Face::Back),
                ..wgpu::PrimitiveState::default()
            },
            depth_stencil: Some(depth_state(if after_depth {
                wgpu::CompareFunction::GreaterEqual
            } else {
                wgpu::CompareFunction::Greater
            })),
            multisample,
            fragment: Some(wgpu::FragmentState {
                module: &shader,
                entry_point: Some("fragment"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets,
            }),
            multiview_mask: None,
            cache: None,
        });
        self.made.insert((*permutation, pass), pipeline);
        Ok(())
    }

    /// The pipeline that draws the surroundings behind everything.
    pub(crate) fn background(&self, device: &wgpu::Device, source: String) -> wgpu::RenderPipeline {
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("relievo background"),
            source: wgpu::ShaderSource::Wgsl(source.into()),
        });
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("relievo background"),
            layout: Some(&self.view_layout),
            vertex: wgpu::VertexState {
                module: &shader,
                entry_point: Some("vertex"),
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
                entry_point: Some("fragment"),
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

fn uniform(binding: u32, has_dynamic_offset: bool) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset,
            min_binding_size: None,
        },
        count: None,
    }
}

fn texture(
    binding: u32,
    sample_type: wgpu::TextureSampleType,
    view_dimension: wgpu::TextureViewDimension,
) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Texture { sample_type, view_dimension, multisampled: false },
        count: None,
    }
}

fn sampler(binding: u32) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
        count: None,
    }
}
