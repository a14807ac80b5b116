//! Drawing the shadow maps.

use super::bindings::view_bindings;
use super::pass_descriptor::{PassDescriptor, cleared};
use super::permutation::Pass;
use super::scene_renderer::Renderer;
use super::shadow_maps::{ShadowMaps, map_size};
use super::shadow_views::ShadowViews;
use crate::GpuError;
use crate::device::Timestamps;

impl Renderer {
    /// Draws the shadow maps for a picture of this size, unless they are up to date; true if it did.
    pub(super) fn draw_shadow_maps(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        picture: [u32; 2],
        stamps: Option<Timestamps<'_>>,
    ) -> Result<bool, GpuError> {
        let count = self.shadows.views.layers.len();
        let largest = self.device.limits().max_texture_dimension_2d;
        let size = map_size(picture, count, self.options.shadow_resolution, largest);
        let maps = &self.shadows.maps;
        let fits = maps.layers.len() == count && (count == 0 || maps.size == size);
        if fits && self.shadows.drawn {
            return Ok(false);
        }
        let (device, layout) = (&self.device, &self.pipelines.view);
        let (lights, stride) = (&self.buffers.lights, self.buffers.stride);
        if !fits {
            self.shadows.maps = ShadowMaps::new(device, &self.shadows.views, size, stride);
            self.view_bindings =
                view_bindings(device, layout, &self.buffers.views, lights, &self.shadows.maps, &self.environment);
        }
        let maps = &self.shadows.maps;
        maps.write_views(&self.queue, &self.shadows.views, stride);
        // A texture cannot be drawn into and looked up at once.
        let nothing = ShadowMaps::new(device, &ShadowViews::default(), 1, stride);
        let bindings = view_bindings(device, layout, &maps.views, lights, &nothing, &self.environment);
        for (number, [depth, objects]) in maps.layers.iter().enumerate() {
            let timestamps = stamps.filter(|_| number == 0).map(|stamps| wgpu::RenderPassTimestampWrites {
                query_set: stamps.set,
                beginning_of_pass_write_index: Some(stamps.begin),
                end_of_pass_write_index: None,
            });
            let to = PassDescriptor {
                kind: Pass::Caster,
                colors: &[Some(cleared(objects, wgpu::Color::TRANSPARENT))],
                depth,
                keeps_depth: false,
                bindings: &bindings,
                view: number as u32,
                timestamps,
            };
            self.pass(encoder, &to);
        }
        self.shadows.drawn = true;
        Ok(count > 0)
    }
}
