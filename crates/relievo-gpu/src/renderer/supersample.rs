//! Several samples per pixel: the whole picture is drawn once for each, a fraction of a pixel aside, and averaged.

use wgpu::util::DeviceExt;

use super::formats::SAMPLE_FORMAT;
use super::pass_descriptor::cleared;
use super::permutation::Output;
use crate::device::wgpu_util::{
    bind_group, bind_group_layout, layout_entries, loaded_texture_type, pipeline_layout, shader_module,
    texture_descriptor, uniform_type, view, whole_view,
};
use crate::{ComposeError, Composer, Permutation};

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
        let shader = shader_module(device, "relievo average", composer.compose("average")?);
        let bindings = [(0, loaded_texture_type()), (1, uniform_type(false))];
        let layout =
            bind_group_layout(device, "relievo average", &layout_entries(wgpu::ShaderStages::FRAGMENT, &bindings));
        let pipeline_layout = pipeline_layout(device, "relievo average", &[&layout]);
        let pipeline = |entry, format, blend| {
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(entry),
                layout: Some(&pipeline_layout),
                vertex: wgpu::VertexState {
                    module: &shader,
                    entry_point: Some("relievo_full_screen"),
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
            add: pipeline("relievo_add_share", SAMPLE_FORMAT, Some(wgpu::BlendState { color: sum, alpha: sum })),
            resolve: pipeline("relievo_resolve", format, None),
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
            let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
            whole_view(&device.create_texture(&texture_descriptor(label, size, SAMPLE_FORMAT, usage)))
        };
        let (sample, sum) = (picture("relievo sample"), picture("relievo sum"));
        let from = |picture| {
            let resources = vec![(0, view(picture)), (1, self.share.as_entire_binding())];
            bind_group(device, "relievo average", &self.layout, resources)
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
            ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
            ..cleared(target, wgpu::Color::BLACK)
        })],
        timestamp_writes,
        ..wgpu::RenderPassDescriptor::default()
    });
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, bindings, &[]);
    pass.draw(0..3, 0..1);
}
