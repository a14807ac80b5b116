//! The render pipelines, one per permutation, made when first needed.

use std::collections::HashMap;

use crate::GpuError;
use crate::layout::VertexLayout;
use crate::render_permutation::{Pass, RenderPermutation};

/// Depth runs from 1 at the near plane to 0 at infinity: with floats, precise everywhere.
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

pub(crate) struct Pipelines {
    pub(crate) view: wgpu::BindGroupLayout,
    pub(crate) surface: wgpu::BindGroupLayout,
    pub(crate) object: wgpu::BindGroupLayout,
    layout: wgpu::PipelineLayout,
    format: wgpu::TextureFormat,
    made: HashMap<(RenderPermutation, Pass), wgpu::RenderPipeline>,
}

impl Pipelines {
    pub(crate) fn new(device: &wgpu::Device, format: wgpu::TextureFormat) -> Self {
        let layout = |label, entries: &[wgpu::BindGroupLayoutEntry]| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
        };
        let view = layout("relievo view", &[uniform(0, true), uniform(1, false)]);
        let mut entries = vec![uniform(0, false), texture(1, false)];
        entries.extend((2..7).map(|binding| texture(binding, true)));
        entries.push(wgpu::BindGroupLayoutEntry {
            binding: 7,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
            count: None,
        });
        let surface = layout("relievo surface", &entries);
        let object = layout("relievo object", &[uniform(0, true)]);
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("relievo"),
            bind_group_layouts: &[Some(&view), Some(&surface), Some(&object)],
            immediate_size: 0,
        });
        Self { view, surface, object, layout, format, made: HashMap::new() }
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
        let targets = [Some(self.format.into())];
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
                cull_mode: permutation.one_sided.then_some(wgpu::Face::Back),
                ..wgpu::PrimitiveState::default()
            },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Greater),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &shader,
                entry_point: Some("fragment"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: if pass == Pass::Color { &targets } else { &[] },
            }),
            multiview_mask: None,
            cache: None,
        });
        self.made.insert((*permutation, pass), pipeline);
        Ok(())
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

fn texture(binding: u32, filterable: bool) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        count: None,
    }
}
