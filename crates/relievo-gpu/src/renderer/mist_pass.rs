//! Passes over mist: before surfaces are drawn the lights that come past it to them, and afterwards its colour over them.

use relievo_scene::mist_order;

use super::mist_targets::MistTargets;
use super::pass_descriptor::{PassDescriptor, cleared};
use super::permutation::Pass;
use super::scene_renderer::Renderer;
use crate::GpuError;

impl Renderer {
    /// Makes everything ready that mist needs for a picture of this size.
    pub(super) fn prepare_mist(&mut self, size: [u32; 2]) -> Result<(), GpuError> {
        if self.mists.is_empty() {
            return Ok(());
        }
        self.make_pipelines(Pass::Depth)?;
        let lights = self.lights.len();
        if !self.mists.targets.as_ref().is_some_and(|targets| targets.fit(size, lights)) {
            let targets = MistTargets::new(
                &self.device,
                [&self.mists.bindings, &self.pipelines.past_mist],
                &self.mists.settings,
                (size, lights),
                self.mists.dims,
            );
            self.mists.targets = Some(targets);
        }
        self.mists.write(&self.queue, lights);
        Ok(())
    }

    /// Draws the depth of the surfaces behind the mist, and the shares of the lights that come past it to them.
    pub(super) fn draw_mist_shadows(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        sample: u32,
        timestamps: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) {
        let Some(targets) = &self.mists.targets else { return };
        self.pass(
            encoder,
            &PassDescriptor {
                kind: Pass::Depth,
                colors: &[],
                depth: &targets.depth,
                keeps_depth: false,
                bindings: &self.view_bindings,
                view: sample,
                timestamps,
            },
        );
        for (light, layer) in targets.layers.iter().enumerate() {
            let mut pass = begin(encoder, cleared(layer, wgpu::Color::WHITE));
            for number in 0..self.mists.volumes.len() {
                pass.set_pipeline(&self.mists.pipelines[number].shadow);
                self.draw_over(&mut pass, targets, sample, (number, Some(light)));
            }
        }
    }

    /// Draws the mist over a picture, from the farthest to the nearest.
    pub(super) fn draw_mist(&self, encoder: &mut wgpu::CommandEncoder, sample: u32, color: &wgpu::TextureView) {
        let Some(targets) = &self.mists.targets else { return };
        let ops = wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store };
        let mut pass =
            begin(encoder, wgpu::RenderPassColorAttachment { ops, ..cleared(color, wgpu::Color::TRANSPARENT) });
        for number in mist_order(&self.mists.volumes, &self.camera) {
            pass.set_pipeline(&self.mists.pipelines[number].color);
            self.draw_over(&mut pass, targets, sample, (number, None));
        }
    }

    /// Draws a mist into every pixel, for its colour or for a light.
    fn draw_over(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        targets: &MistTargets,
        sample: u32,
        (number, light): (usize, Option<usize>),
    ) {
        let (volume, stride) = (&self.mists.volumes[number], self.buffers.stride);
        pass.set_bind_group(0, &self.view_bindings, &[sample * stride]);
        pass.set_bind_group(1, &self.materials[volume.material].bindings, &[]);
        pass.set_bind_group(2, &self.buffers.object_bindings, &[volume.object as u32 * stride]);
        pass.set_bind_group(3, &targets.over_surfaces, &[self.mists.offset(number, light)]);
        pass.draw(0..3, 0..1);
    }
}

/// Begins a pass without depth.
fn begin<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    color: wgpu::RenderPassColorAttachment<'_>,
) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("relievo mist"),
        color_attachments: &[Some(color)],
        ..wgpu::RenderPassDescriptor::default()
    })
}
