//! Measurements of a picture, read back from the device.

use relievo_map::Grid;
use relievo_scene::{Aovs, Frame};

use super::formats::MEASURE_FORMAT;
use super::pass_descriptor::cleared;
use super::permutation::Pass;
use crate::GpuError;
use crate::device::read_texture;
use crate::device::wgpu_util::{texture_descriptor, whole_view};

/// A texture of four floats per pixel.
struct Channel {
    texture: wgpu::Texture,
    view: wgpu::TextureView,
}

/// The sums over the samples of a picture.
pub(crate) struct Measured {
    size: [u32; 2],
    /// Channels by their names in the shaders: `surface`, `march` and `light`.
    channels: [Channel; 3],
    aovs: Aovs,
    samples: u32,
}

impl Measured {
    pub(crate) fn new(device: &wgpu::Device, [width, height]: [u32; 2]) -> Self {
        let channels = std::array::from_fn(|_| {
            let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
            let texture =
                device.create_texture(&texture_descriptor("relievo measured", [width, height], MEASURE_FORMAT, usage));
            let view = whole_view(&texture);
            Channel { texture, view }
        });
        Self { size: [width, height], channels, aovs: Frame::blank(width, height).aovs, samples: 0 }
    }

    /// The passes of a sample with their attachments.
    pub(crate) fn passes(&self) -> [(Pass, Vec<Option<wgpu::RenderPassColorAttachment<'_>>>); 2] {
        fn attachment(channel: &Channel) -> Option<wgpu::RenderPassColorAttachment<'_>> {
            Some(cleared(&channel.view, wgpu::Color::TRANSPARENT))
        }
        let [surface, march, light] = &self.channels;
        [
            (Pass::MeasureSurface, vec![attachment(surface), attachment(march)]),
            (Pass::MeasureLight, vec![attachment(light)]),
        ]
    }

    /// Adds the sample that was submitted last, once it is drawn.
    pub(crate) fn read(&mut self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<(), GpuError> {
        let [width, height] = self.size;
        let read = |k: usize| -> Result<Grid<[f32; 4]>, GpuError> {
            let bytes = read_texture(device, queue, &self.channels[k].texture)?;
            let pixel = |x: u32, y: u32| {
                let start = 16 * (y as usize * width as usize + x as usize);
                bytemuck::pod_read_unaligned(&bytes[start..start + 16])
            };
            Ok(Grid::from_fn(width, height, pixel))
        };
        let (surface, march, light) = (read(0)?, read(1)?, read(2)?);
        let aovs = &mut self.aovs;
        for i in 0..surface.texels().len() {
            let ([nx, ny, nz, view_depth], [u, v, fetches, iterations]) = (surface.texels()[i], march.texels()[i]);
            let [shadow, number, ..] = light.texels()[i];
            let hit = number > 0.0;
            if self.samples == 0 {
                aovs.depth.texels_mut()[i] = if hit { view_depth } else { f32::INFINITY };
                aovs.normal.texels_mut()[i] = [nx, ny, nz];
                aovs.uv.texels_mut()[i] = [u, v];
                aovs.material.texels_mut()[i] = hit.then(|| number as u32 - 1);
            }
            aovs.fetches.texels_mut()[i] += fetches;
            aovs.iterations.texels_mut()[i] += iterations;
            aovs.shadow.texels_mut()[i] += if hit { shadow } else { 1.0 };
            aovs.hit.texels_mut()[i] += f32::from(u8::from(hit));
        }
        self.samples += 1;
        Ok(())
    }

    /// The means.
    pub(crate) fn aovs(mut self) -> Aovs {
        let n = self.samples.max(1) as f32;
        let Aovs { fetches, iterations, shadow, hit, .. } = &mut self.aovs;
        for grid in [fetches, iterations, shadow, hit] {
            grid.texels_mut().iter_mut().for_each(|x| *x /= n);
        }
        self.aovs
    }
}
