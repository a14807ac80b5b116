//! Drawing and measuring pictures.

use relievo_scene::Aovs;

use super::check::check_picture;
use super::measure::Measured;
use super::options::Target;
use super::pass_descriptor::{PassDescriptor, cleared};
use super::permutation::Pass;
use super::scene_renderer::Renderer;
use super::view::{Sample, eye, view};
use crate::GpuError;
use crate::device::guarded;

impl Renderer {
    /// Draws into all of `target`. Returns when the work is submitted, not when it is done.
    ///
    /// # Errors
    /// If a side of the size is 0 or over the device's limit, the views are not as [`Target`] says, or the device fails.
    pub fn draw(&mut self, target: &Target<'_>) -> Result<(), GpuError> {
        self.submitted(|this, encoder| this.record(encoder, target))
    }

    /// Draws the depth alone, with the march that [`Renderer::draw`] uses, equal to the last bit. `depth` is as
    /// [`Target::depth`], but with one sample: the one in the pixels' middle.
    ///
    /// # Errors
    /// As [`Renderer::draw`].
    pub fn draw_depth(&mut self, depth: &wgpu::TextureView, size: [u32; 2]) -> Result<(), GpuError> {
        self.submitted(|this, encoder| this.record_depth(encoder, depth, size))
    }

    /// Measures instead of drawing: everything but colours, as `relievo-cpu` gives it, and what the marches cost. Of a pixel
    /// that several reliefs lie behind, the cost is that of the one that is seen. Blocks until it is done.
    ///
    /// # Errors
    /// If a side of the size is 0 or over the device's limit, the device cannot draw into float textures (which is so on
    /// some of WebGL2's class), or the device fails.
    pub fn measure(&mut self, size: [u32; 2]) -> Result<Aovs, GpuError> {
        let device = self.device.clone();
        let measured = guarded(&device, || {
            self.look(size)?;
            for kind in [Pass::MeasureSurface, Pass::MeasureLight] {
                self.make_pipelines(kind)?;
            }
            let mut measured = Measured::new(&self.device, size);
            let depth = self.attachments.single_depth(&self.device, size);
            for sample in 0..self.samples {
                let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
                if sample == 0 {
                    self.draw_shadow_maps(&mut encoder, size, None)?;
                    self.prepare_mist(size)?;
                }
                self.draw_mist_shadows(&mut encoder, sample, None);
                for (kind, colors) in measured.passes() {
                    self.pass(&mut encoder, &PassDescriptor { view: sample, ..self.descriptor(kind, &colors, &depth) });
                }
                self.queue.submit([encoder.finish()]);
                measured.read(&self.device, &self.queue)?;
            }
            Ok(measured.aovs())
        });
        // Nothing that was submitted with what failed is sure to be there.
        self.shadows.drawn &= measured.is_ok();
        measured
    }

    /// Records [`Renderer::draw`] as part of the caller's own commands, which must be submitted before the next ones are
    /// recorded. Failures of the device come up where those are submitted.
    ///
    /// # Errors
    /// If a side of the size is 0 or over the device's limit.
    pub fn record(&mut self, encoder: &mut wgpu::CommandEncoder, target: &Target<'_>) -> Result<(), GpuError> {
        self.look(target.size)?;
        self.make_pipelines(Pass::Color)?;
        if self.options.depth_prepass {
            self.make_pipelines(Pass::Depth)?;
        }
        self.prepare_mist(target.size)?;
        let begun = self.draw_shadow_maps(encoder, target.size, target.timestamps)?;
        let writes = |begins: bool, ends: bool| {
            let stamps = target.timestamps?;
            let begin = (begins && !begun).then_some(stamps.begin);
            let end = ends.then_some(stamps.end);
            (begin.is_some() || end.is_some()).then_some(wgpu::RenderPassTimestampWrites {
                query_set: stamps.set,
                beginning_of_pass_write_index: begin,
                end_of_pass_write_index: end,
            })
        };
        let depth = target.depth.cloned().unwrap_or_else(|| self.attachments.depth(&self.device, target.size));
        let sampled = self.supersampler.as_mut().map(|sampler| sampler.target(&self.device, target.size));
        let color = sampled.as_ref().unwrap_or(target.color);
        let multisampled = self.attachments.multisampled(&self.device, target.size);
        let prepass = self.options.depth_prepass && multisampled.is_none();
        let mist = !self.mists.is_empty();
        for index in 0..self.samples {
            let attachment = wgpu::RenderPassColorAttachment {
                resolve_target: multisampled.as_ref().map(|_| color),
                ..cleared(multisampled.as_ref().unwrap_or(color), self.background)
            };
            self.draw_mist_shadows(encoder, index, writes(index == 0 && mist, false));
            if prepass {
                let to = self.descriptor(Pass::Depth, &[], &depth);
                self.pass(
                    encoder,
                    &PassDescriptor { view: index, timestamps: writes(index == 0 && !mist, false), ..to },
                );
            }
            let timestamps = writes(index == 0 && !prepass && !mist, sampled.is_none());
            let colors = [Some(attachment)];
            let to = self.descriptor(Pass::Color, &colors, &depth);
            self.pass(encoder, &PassDescriptor { view: index, keeps_depth: prepass, timestamps, ..to });
            self.draw_mist(encoder, index, color);
            if let Some(supersampler) = &self.supersampler {
                supersampler.add(encoder, index == 0);
            }
        }
        if let Some(supersampler) = &self.supersampler {
            supersampler.resolve(encoder, target.color, writes(false, true));
        }
        Ok(())
    }

    /// Records [`Renderer::draw_depth`] as part of the caller's own commands; see [`Renderer::record`].
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
        self.make_pipelines(Pass::Depth)?;
        self.pass(encoder, &self.descriptor(Pass::Depth, &[], depth));
        Ok(())
    }

    fn submitted(
        &mut self,
        record: impl FnOnce(&mut Self, &mut wgpu::CommandEncoder) -> Result<(), GpuError>,
    ) -> Result<(), GpuError> {
        let device = self.device.clone();
        let done = guarded(&device, || {
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            record(self, &mut encoder)?;
            self.queue.submit([encoder.finish()]);
            Ok(())
        });
        self.shadows.drawn &= done.is_ok();
        done
    }

    /// A pass by the first view that clears depth.
    fn descriptor<'a>(
        &'a self,
        kind: Pass,
        colors: &'a [Option<wgpu::RenderPassColorAttachment<'a>>],
        depth: &'a wgpu::TextureView,
    ) -> PassDescriptor<'a> {
        let bindings = &self.view_bindings;
        PassDescriptor { kind, colors, depth, keeps_depth: false, bindings, view: 0, timestamps: None }
    }

    /// Sets the camera up for all samples of a picture of this size.
    fn look(&mut self, size: [u32; 2]) -> Result<(), GpuError> {
        check_picture(&self.device, size)?;
        self.geometry.see_from(&eye(&self.camera, self.bounds, size));
        let stride = self.buffers.stride;
        for index in 0..self.samples {
            let sample = Sample { index, count: self.samples };
            let layout = view(&self.camera, self.bounds, &self.shading, self.lights.len(), size, sample);
            self.queue.write_buffer(&self.buffers.views, u64::from(index * stride), bytemuck::bytes_of(&layout));
        }
        Ok(())
    }
}
