//! Several samples per pixel: the whole picture is drawn once for each, a fraction of a pixel aside, and averaged.

use wgpu::util::DeviceExt;

use crate::render_permutation::Output;
use crate::{ComposeError, Composer, Permutation};

/// What samples are drawn and summed in: floats, for colours are clamped only after averaging.
pub(crate) const SAMPLE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

pub(crate) struct Supersampler {
    layout: wgpu::BindGroupLayout,
    add: wgpu::RenderPipeline,
    resolve: wgpu::RenderPipeline,
    share: wgpu::Buffer,
    pictures: Option<Pictures>,
}

struct Pictures {
    size: [u32; 2],
    sample: wgpu::TextureView,
    sum: wgpu::TextureView,
    from_sample: wgpu::BindGroup,
    from_sum: wgpu::BindGroup,
}

impl Supersampler {
    pub(crate) fn new(
        device: &wgpu::Device,
        samples: u32,
        format: wgpu::TextureFormat,
        output: Output,
    ) -> Result<Self, ComposeError> {
        let mut composer = Composer::new(&Permutation::default());
        composer.add("chosen_output", output.module());
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("relievo average"),
            source: wgpu::ShaderSource::Wgsl(composer.compose("average")?.into()),
        });
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty,
            count: None,
        };
        let texture = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let uniform = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("relievo average"),
            entries: &[entry(0, texture), entry(1, uniform)],
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("relievo average"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let pipeline = |entry, format, blend| {
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(entry),
                layout: Some(&pipeline_layout),
                vertex: wgpu::VertexState {
                    module: &shader,
                    entry_point: Some("whole_picture"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    buffers: &[],
                },
                primitive: wgpu::PrimitiveState::default(),
                depth_stencil: None,
                multisample: wgpu::MultisampleState::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &shader,
                    entry_point: Some(entry),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    targets: &[Some(wgpu::ColorTargetState { format, blend, write_mask: wgpu::ColorWrites::ALL })],
                }),
                multiview_mask: None,
                cache: None,
            })
        };
        let sum = wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::One,
            dst_factor: wgpu::BlendFactor::One,
            operation: wgpu::BlendOperation::Add,
        };
        let share = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("relievo share"),
            contents: bytemuck::bytes_of(&[1.0 / samples as f32; 4]),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        Ok(Self {
            add: pipeline("add_share", SAMPLE_FORMAT, Some(wgpu::BlendState { color: sum, alpha: sum })),
            resolve: pipeline("resolve", format, None),
            layout,
            share,
            pictures: None,
        })
    }

    /// The view that the next sample of a picture of this size is drawn into.
    pub(crate) fn target(&mut self, device: &wgpu::Device, size: [u32; 2]) -> wgpu::TextureView {
        if let Some(pictures) = &self.pictures
            && pictures.size == size
        {
            return pictures.sample.clone();
        }
        let picture = |label| {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: SAMPLE_FORMAT,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        let (sample, sum) = (picture("relievo sample"), picture("relievo sum"));
        let from = |view| {
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("relievo average"),
                layout: &self.layout,
                entries: &[
                    wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(view) },
                    wgpu::BindGroupEntry { binding: 1, resource: self.share.as_entire_binding() },
                ],
            })
        };
        let (from_sample, from_sum) = (from(&sample), from(&sum));
        let target = sample.clone();
        self.pictures = Some(Pictures { size, sample, sum, from_sample, from_sum });
        target
    }

    /// Adds the sample that was drawn last.
    pub(crate) fn add(&self, encoder: &mut wgpu::CommandEncoder, first: bool) {
        let Some(pictures) = &self.pictures else { return };
        let load = if first { wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) } else { wgpu::LoadOp::Load };
        whole(encoder, &self.add, &pictures.from_sample, &pictures.sum, load, None);
    }

    /// Draws the mean.
    pub(crate) fn resolve(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        timestamps: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) {
        let Some(pictures) = &self.pictures else { return };
        whole(encoder, &self.resolve, &pictures.from_sum, target, wgpu::LoadOp::Clear(wgpu::Color::BLACK), timestamps);
    }
}

/// One pass over all of `target`.
fn whole(
    encoder: &mut wgpu::CommandEncoder,
    pipeline: &wgpu::RenderPipeline,
    bindings: &wgpu::BindGroup,
    target: &wgpu::TextureView,
    load: wgpu::LoadOp<wgpu::Color>,
    timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
) {
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("relievo average"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: target,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
        })],
        timestamp_writes,
        ..wgpu::RenderPassDescriptor::default()
    });
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, bindings, &[]);
    pass.draw(0..3, 0..1);
}
