//! Shadow maps of a scene: which there are, and whether they show the scene as it is.

use relievo_scene::Light;

use super::layout::{LightLayout, MAX_LIGHTS};
use super::shadow_maps::ShadowMaps;
use super::shadow_views::{Caster, ShadowViews};
use super::view;
use crate::GpuError;

pub(crate) struct Shadows {
    pub(crate) views: ShadowViews,
    pub(crate) maps: ShadowMaps,
    /// True if the maps show the scene as it is.
    pub(crate) drawn: bool,
}

impl Shadows {
    /// Shadows without any map yet.
    pub(crate) fn new(device: &wgpu::Device, stride: u32) -> Self {
        let views = ShadowViews::default();
        let maps = ShadowMaps::new(device, &views, 1, stride);
        Self { views, maps, drawn: false }
    }

    /// Plans the maps of lights that throw the shadows of `casters`, and gives the lights as shaders take them. Refuses more
    /// lights than there is room for.
    pub(crate) fn plan(
        &mut self,
        lights: &[Light],
        casters: Option<&[Caster]>,
    ) -> Result<[LightLayout; MAX_LIGHTS], GpuError> {
        let mut layouts = view::lights(lights)?;
        self.views = casters.map_or_else(ShadowViews::default, |casters| ShadowViews::new(lights, casters));
        self.views.write(&mut layouts);
        self.drawn = false;
        Ok(layouts)
    }
}
